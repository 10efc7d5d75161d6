// The stages of reading a deck: text, includes, overrides, variables, structure, rules.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "deck/around.h"
#include "deck/copies.h"
#include "deck/deck_file.h"
#include "deck/model.h"
#include "deck/scalar_reading.h"
#include "deck/yaml_reader.h"

namespace sphgeo {

namespace {

std::vector<std::string> top_level_keys() {
  std::vector<std::string> out;
  for (const Key& key : schema_of<Model>().keys()) out.push_back(key.name());
  return out;
}

/// Reads one top-level number ahead of the rest, silently: points depend on the dimension, and
/// rules may ask for the spacing. Its errors are reported when the whole deck is read.
double number_ahead(const Node& root, const std::string& name, const DeckReading& reading) {
  const Entry* entry = root.find(name);
  if (entry == nullptr) return 0.0;
  for (const Key& key : schema_of<Model>().keys()) {
    if (key.name() != name) continue;
    Diagnostics unheard;
    Places nowhere;
    DeckReading trial(unheard, nowhere);
    trial.variables = reading.variables;
    double value = 0.0;
    return read_number(entry->value, key, name, trial, value) ? value : 0.0;
  }
  return 0.0;
}

/// The section `variables`, also when its name is misspelt: that is one error, and the formulas
/// that use its names are none.
const Entry* find_variables(const Node& root) {
  if (const Entry* entry = root.find("variables")) return entry;
  for (const Entry& entry : root.entries) {
    if (!nearest_name(entry.key, {"variables"}).empty()) return &entry;
  }
  return nullptr;
}

/// Whether parts of the deck are missing, so that further errors would only follow from these.
bool leaves_holes(const Diagnostics& found) {
  return std::any_of(found.items().begin(), found.items().end(), [](const Diagnostic& d) {
    return d.severity == Severity::error && d.id != "E003" && d.id != "E005";
  });
}

Model read(const DeckText& deck, const std::vector<std::string>& overrides) {
  Diagnostics found;
  std::optional<Node> root = read_deck_tree(deck, found);
  if (!root || leaves_holes(found)) throw DeckError(std::move(found));
  apply_overrides(*root, overrides, top_level_keys(), found);

  Model model;
  DeckReading reading(found, model.places);
  reading.main_file = deck.name;
  reading.folder = deck.folder;
  model.places[""] = root->place;
  const double dimension = number_ahead(*root, "dimension", reading);
  if (dimension == 2.0 || dimension == 3.0) {
    reading.dimension = static_cast<int>(dimension);
    reading.variables.values.emplace_back("dimension", dimension);
  }
  if (const Entry* variables = find_variables(*root)) read_variables(variables->value, reading);
  reading.resolution = number_ahead(*root, "resolution", reading);
  // A resolution that cannot be read is an error of its own: NaN keeps formulas that use it silent.
  reading.variables.values.emplace_back("resolution",
                                        reading.resolution > 0 ? reading.resolution : std::nan(""));
  expand_copies(*root, reading);
  expand_around(*root, reading);
  read_mapping(*root, {{&schema_of<Model>(), &model}}, {}, reading);
  if (found.has_errors()) throw DeckError(std::move(found));

  for (const auto& rule : reading.rules) rule();
  if (found.has_errors()) throw DeckError(std::move(found));
  model.warnings = std::move(found);
  return model;
}

}  // namespace

Model read_deck(const std::string& path, const std::vector<std::string>& overrides) {
  Diagnostics found;
  std::optional<std::string> text = read_text_file(path, {path, 0, 0}, found);
  if (!text) throw DeckError(std::move(found));
  if (path == "-") return read({"<stdin>", ".", std::move(*text)}, overrides);
  return read({path, std::filesystem::path(path).parent_path().string(), std::move(*text)},
              overrides);
}

Model read_deck_text(const std::string& text, const std::vector<std::string>& overrides,
                     const std::string& name, const std::string& folder) {
  return read({name, folder, text}, overrides);
}

}  // namespace sphgeo
