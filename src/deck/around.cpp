#include "deck/around.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"

namespace sphgeo {
namespace {

std::string name_of(const Node& body) {
  const Entry* name = body.kind == Node::Kind::map ? body.find("name") : nullptr;
  return name ? name->value.text : std::string();
}

/// Whether `name` is NAME_1, NAME_2 ...: a copy of NAME.
bool is_copy(const std::string& name, const std::string& original) {
  return name.size() > original.size() + 1 && name.starts_with(original) &&
         name[original.size()] == '_' &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(original.size()) + 1, name.end(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

/// Shapes of the bodies that a name refers to: the body itself and its copies.
std::vector<Node> shapes_of(const std::vector<Node>& bodies, const std::string& name) {
  std::vector<Node> out;
  for (const Node& body : bodies) {
    const std::string own = name_of(body);
    if (own != name && !is_copy(own, name)) continue;
    // A missing shape is reported when the body is read.
    if (const Entry* shape = body.find("shape")) out.push_back(shape->value);
  }
  return out;
}

/// Suggestions for a misspelt name: all other bodies, and the bodies that they are copies of.
std::vector<std::string> candidates(const std::vector<Node>& bodies, const std::string& but) {
  std::vector<std::string> out;
  for (const Node& body : bodies) {
    const std::string name = name_of(body);
    if (name.empty() || name == but) continue;
    out.push_back(name);
    const std::size_t end = name.rfind('_');
    if (end != std::string::npos && is_copy(name, name.substr(0, end)))
      out.push_back(name.substr(0, end));
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

void expand_around(Node& root, DeckReading& reading) {
  Entry* list = root.find("bodies");
  if (!list || list->value.kind != Node::Kind::list) return;
  const std::vector<Node> before = list->value.items;
  for (std::size_t k = 0; k < before.size(); ++k) {
    Node& body = list->value.items[k];
    if (body.kind != Node::Kind::map || !body.find("around")) continue;
    const Entry around = *body.find("around");
    std::erase_if(body.entries, [](const Entry& e) { return e.key == "around"; });
    const std::string path = fmt::format("bodies[{}].around", k);
    reading.places[path] = around.place;
    if (around.value.kind != Node::Kind::list) {
      reading.error("E030", around.value.place, path,
                    fmt::format("{} where names of bodies are expected", around.value.words()),
                    "write around: [boulder]");
      continue;
    }
    std::vector<Node> shapes;
    for (const Node& item : around.value.items) {
      const std::vector<Node> found = item.kind == Node::Kind::scalar && item.text != name_of(body)
                                          ? shapes_of(before, item.text)
                                          : std::vector<Node>();
      if (found.empty())
        reading.error("E030", item.place, path,
                      fmt::format("there is no other body {}", item.words()),
                      suggestion(item.text, candidates(before, name_of(body)), "other bodies"));
      shapes.insert(shapes.end(), found.begin(), found.end());
    }
    Entry* shape = body.find("shape");
    if (!shape || shapes.empty()) continue;
    Node less = Node::map();
    less.place = shape->value.place;
    shapes.insert(shapes.begin(), std::move(shape->value));
    Node type = Node::scalar("difference");
    type.place = less.place;
    less.add("type", std::move(type));
    less.add("of", Node::list(std::move(shapes)));
    for (Entry& e : less.entries) e.place = e.value.place = less.place;
    shape->value = std::move(less);
  }
}

}  // namespace sphgeo
