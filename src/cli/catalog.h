#pragma once
// The elements of decks and plans, from their declarations: for `list`, `show` and `reference`.

#include <string>
#include <utility>
#include <vector>

#include "core/column.h"

namespace sphgeo {

/// One key of a type or section.
struct KeyFacts {
  std::string name, sentence;
  std::string equation;   ///< of the paper; "" when there is none
  std::string accepts;    ///< accepted values: kind, unit, range
  std::string otherwise;  ///< the default as a deck may hold it; "" when there is none
  bool required = false;
  bool changeable = false;  ///< may differ when a run is resumed
};

/// A section of the deck, a type of material, shape, boundary or probe, an effect or a field.
struct CatalogEntry {
  std::string name, sentence;
  std::vector<KeyFacts> keys;  ///< of sections and types
  /// Of effects and fields: "stage: force", "unit: Pa" ...
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<Column> columns = {};  ///< of a probe in 3D, with the defaults of its keys
};

/// Entries of one kind, sorted as they are shown.
struct CatalogGroup {
  std::string kind;      ///< "shape", "section", "effect" ...
  std::string heading;   ///< "shapes"
  std::string sentence;  ///< what they are
  std::vector<CatalogEntry> entries;
};

/// All entries.
std::vector<CatalogGroup> catalog();

}  // namespace sphgeo
