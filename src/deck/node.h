#pragma once
// The plain tree a deck file becomes: nothing after the YAML reader depends on the YAML library.

#include <map>
#include <string>
#include <vector>

#include "core/diagnostic.h"

namespace sphgeo {

struct Entry;

/// One value of a deck: a scalar, a list or a mapping, with the place where it stands.
struct Node {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  Place place;                 ///< of the value itself
  std::string text;            ///< of a scalar, as written
  bool quoted = false;         ///< the scalar was written in quotes
  std::vector<Node> items;     ///< of a list
  std::vector<Entry> entries;  ///< of a mapping, in the order of the file

  static Node scalar(std::string value, bool in_quotes = false);
  static Node list();
  static Node list(std::vector<Node> values);
  static Node map();

  /// The entry of a mapping with this key, or nullptr.
  const Entry* find(const std::string& key) const;
  Entry* find(const std::string& key);
  /// Appends an entry to a mapping.
  Node& add(std::string key, Node value);
  /// What a user would call it: "a mapping", "a list", "nothing", "'text'".
  std::string words() const;
};

/// One `key: value` of a mapping; `place` is that of the key.
struct Entry {
  std::string key;
  Place place;
  Node value;
};

/// Where every key path of a deck stands ("bodies[0].shape.max" -> file:line:column).
using Places = std::map<std::string, Place>;

/// `base.key`, or `key` alone at the top level.
std::string join_path(const std::string& base, const std::string& key);

/// The place of the path, or of its nearest ancestor that stands in the deck.
Place place_in(const Places& places, std::string path);

}  // namespace sphgeo
