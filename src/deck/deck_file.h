#pragma once
// From deck files to one tree: `include` merges other files, `--set` replaces single values.

#include <optional>
#include <string>
#include <vector>

#include "core/diagnostic.h"
#include "deck/node.h"

namespace sphgeo {

/// A deck's text before it is read.
struct DeckText {
  std::string name;    ///< the file, as findings show it
  std::string folder;  ///< relative paths count from here
  std::string text;
};

/// Reads the text and all files it includes and merges them: lists of mappings are appended (those
/// of included files first), mappings merged, any other key given twice is an error.
std::optional<Node> read_deck_tree(const DeckText& deck, Diagnostics& found);

/// Applies `--set` overrides `path=value`, each named "--set #n" in findings. A bare name is a deck
/// variable or one of the `top_keys`; list elements are addressed by number or by their `name`.
void apply_overrides(Node& root, const std::vector<std::string>& overrides,
                     const std::vector<std::string>& top_keys, Diagnostics& found);

}  // namespace sphgeo
