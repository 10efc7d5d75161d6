#pragma once
// Allowed differences of a run from its baseline.

#include <string>
#include <vector>

#include "deck/schema.h"

namespace sphgeo {

/// A tolerance for findings by name.
struct ToleranceRule {
  std::string name;      ///< of findings, with * for any part: "probe gauge.*"
  double tolerance = 0;  ///< 1e300: any difference
  static Schema<ToleranceRule> schema();
};

/// Tolerances as shares: of a curve's or field's range, of a quantity's size.
struct Tolerances {
  double probes = 0.02;
  double fields = 0.05;
  double positions = 0.5;  ///< mean distance to the nearest particle, in spacings
  double ledger = 0.01;
  double results = 0.02;
  double steps = 0.05;
  double particles = 0;
  std::vector<ToleranceRule> rules;  ///< the last that matches applies
  static Schema<Tolerances> schema();

  /// The tolerance of the finding "kind name" ("probe gauge.level").
  double of(const std::string& kind, const std::string& name) const;
};

/// Reads a YAML file of these keys. Throws DeckError with file, line and column.
Tolerances read_tolerances(const std::string& path);

}  // namespace sphgeo
