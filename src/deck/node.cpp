#include "deck/node.h"

#include <fmt/format.h>

#include <utility>

#include "core/text.h"

namespace sphgeo {

Node Node::scalar(std::string value, bool in_quotes) {
  Node n;
  n.kind = Kind::scalar;
  n.text = std::move(value);
  n.quoted = in_quotes;
  return n;
}

Node Node::list() {
  Node n;
  n.kind = Kind::list;
  return n;
}

Node Node::list(std::vector<Node> values) {
  Node n;
  n.kind = Kind::list;
  n.items = std::move(values);
  return n;
}

Node Node::map() {
  Node n;
  n.kind = Kind::map;
  return n;
}

const Entry* Node::find(const std::string& key) const {
  for (const Entry& e : entries) {
    if (e.key == key) return &e;
  }
  return nullptr;
}

Entry* Node::find(const std::string& key) {
  return const_cast<Entry*>(std::as_const(*this).find(key));
}

Node& Node::add(std::string key, Node value) {
  entries.push_back({std::move(key), value.place, std::move(value)});
  return entries.back().value;
}

std::string Node::words() const {
  constexpr std::size_t longest = 60;
  switch (kind) {
    case Kind::null:
      return "nothing";
    case Kind::list:
      return fmt::format("a list of {}", items.size());
    case Kind::map:
      return "a mapping";
    case Kind::scalar:
      break;
  }
  return fmt::format("'{}'", shortened(text, longest));
}

std::string join_path(const std::string& base, const std::string& key) {
  if (base.empty()) return key;
  if (key.empty()) return base;
  return key.front() == '[' ? base + key : base + "." + key;
}

Place place_in(const Places& places, std::string path) {
  for (;;) {
    if (const auto found = places.find(path); found != places.end()) return found->second;
    if (path.empty()) return {};
    const std::size_t cut = path.find_last_of(".[");
    path.resize(cut == std::string::npos ? 0 : cut);
  }
}

}  // namespace sphgeo
