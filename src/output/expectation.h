#pragma once
// Measures the claims of a deck (its section `expect`).

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sphgeo {

struct Expect;
class Series;

/// One result that the deck claims, as it was measured.
struct ExpectResult {
  std::string name;
  std::optional<double> value;  ///< empty: could not be measured, see note
  std::optional<double> reference;
  /// The error that `study` uses: |value - reference| (by |reference| if relative), a curve's norm,
  /// the value itself for `below`; empty for `above`.
  std::optional<double> error;
  double tolerance = 0;
  bool pass = false;
  bool partial = false;  ///< samples reach only a part of the reference
  std::string note;      ///< why it could not be measured, or what was left out
};

/// Finds the series of a probe by its name; nullptr when there is none.
using SeriesLookup = std::function<const Series*(const std::string& probe)>;

/// Measures one claim. A claim that cannot be measured fails with a note; it does not throw, except
/// IoError and TableError for an unreadable reference table.
ExpectResult evaluate(const Expect& expect, const SeriesLookup& series);

/// Measures all of them, in the order of the deck.
std::vector<ExpectResult> evaluate(std::span<const Expect> expects, const SeriesLookup& series);

/// A table for the terminal: name, value, reference, error, tolerance, pass or FAIL, and the notes.
std::string render_expectations(std::span<const ExpectResult> results);

}  // namespace sphgeo
