#pragma once
// Strict YAML: what the library accepts silently is refused here, with its place.

#include <optional>
#include <string>

#include "core/diagnostic.h"
#include "deck/node.h"

namespace sphgeo {

/// Bounds against decks that are too large by accident or on purpose (aliases that multiply).
struct YamlLimits {
  std::size_t bytes = 10u << 20;  ///< of the file, and of all texts once aliases are replaced
  std::size_t line =
      256u << 10;  ///< of one line: the library parses it before it returns its first value
  /// Brackets, braces and commas: likewise, up to the end of the outermost bracket, some 260 bytes
  /// for each.
  std::size_t punctuation = 600000;
  std::size_t text = 20000;  ///< of one value
  std::size_t key = 200;     ///< of one key
  int nodes = 200000;        ///< values, once aliases are replaced
  int keys = 5000;           ///< of one mapping
  int depth = 60;
};

/// Reads one YAML document. Duplicate keys, merge keys (`<<`), tags, keys that are no text, a
/// second document, control characters (also those that a quoted text writes as `\e` or `\x07`),
/// bytes that are no UTF-8 and texts beyond the limits are errors. `name` is the file in findings.
/// Empty when the text cannot be read at all.
std::optional<Node> read_yaml(const std::string& text, const std::string& name, Diagnostics& found,
                              const YamlLimits& limits = {});

/// The whole file, or standard input for "-". Reports E001 (E006 when it is longer than `limit`)
/// and returns empty on failure. `only_regular` refuses pipes and devices, which may have no end.
std::optional<std::string> read_text_file(const std::string& path, const Place& named_at,
                                          Diagnostics& found, bool only_regular = false,
                                          std::size_t limit = YamlLimits{}.bytes);

}  // namespace sphgeo
