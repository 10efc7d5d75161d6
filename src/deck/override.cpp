// `--set path=value`.

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "core/text.h"
#include "deck/deck_file.h"
#include "deck/yaml_reader.h"

namespace sphgeo {

namespace {

/// One step of a path: a key (or the `name` of a list element), or an index.
struct Step {
  std::string key;
  int index = -1;
  int column = 1;  ///< where it stands in the override, from 1
};

struct Override {
  std::string name;  ///< "--set #1"
  std::vector<Step> steps;
  std::string path;
  Node value;
};

bool is_name_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

/// Splits "a.b[0].c"; empty when it is malformed.
std::vector<Step> parse_path(const std::string& path) {
  std::vector<Step> steps;
  std::size_t k = 0;
  while (k < path.size()) {
    const int column = static_cast<int>(k) + 1;
    if (path[k] == '[' && !steps.empty()) {
      const std::size_t end = path.find(']', k);
      if (end == std::string::npos) return {};
      int index = -1;
      const auto [stop, problem] = std::from_chars(path.data() + k + 1, path.data() + end, index);
      if (problem != std::errc{} || stop != path.data() + end || index < 0) return {};
      steps.push_back({{}, index, column});
      k = end + 1;
      continue;
    }
    if (!steps.empty()) {
      if (path[k] != '.') return {};
      ++k;
    }
    const std::size_t from = k;
    while (k < path.size() && is_name_letter(path[k])) ++k;
    if (k == from) return {};
    steps.push_back({path.substr(from, k - from), -1, static_cast<int>(from) + 1});
  }
  return steps;
}

std::vector<std::string> names_in(const Node& list) {
  std::vector<std::string> names;
  for (const Node& item : list.items) {
    if (const Entry* name = item.find("name")) names.push_back(name->value.text);
  }
  return names;
}

class Overrider {
 public:
  Overrider(Node& root, const std::vector<std::string>& top_keys, Diagnostics& found)
      : root_(root), top_keys_(top_keys), found_(found) {}

  void apply(const std::string& text, int number) {
    Override o;
    o.name = fmt::format("--set #{}", number);
    found_.keep_source(o.name, text);
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos) {
      o.path = std::string(trimmed(text.substr(0, equals)));
      o.steps = parse_path(o.path);
    }
    if (o.steps.empty()) {
      found_.error("E008", {o.name, 1, 1}, {}, fmt::format("cannot read the override '{}'", text),
                   "write path=value, such as bodies[0].shape.max[0]=0.4");
      return;
    }
    // Blanks in front keep the columns of the value those of the override.
    const std::string padded = std::string(equals + 1, ' ') + text.substr(equals + 1);
    const std::optional<Node> value = read_yaml(padded, o.name, found_);
    if (!value) return;
    o.value = *value;
    if (o.value.kind == Node::Kind::null) o.value.place = {o.name, 1, static_cast<int>(equals) + 1};
    if (o.steps[0].key == "include") {
      refuse(o, o.steps[0], "'include' cannot be overridden", "included files are merged first");
    } else if (o.steps.size() == 1) {
      apply_bare(o);
    } else {
      apply_path(o);
    }
  }

 private:
  void refuse(const Override& o, const Step& at, std::string message, std::string help) {
    found_.error("E008", {o.name, 1, at.column}, {}, std::move(message), std::move(help));
  }

  static void replace(Entry& entry, const Override& o, const Step& at) {
    entry.value = o.value;
    entry.place = {o.name, 1, at.column};
  }

  void apply_bare(const Override& o) {
    const Step& step = o.steps[0];
    Entry* variables = root_.find("variables");
    if (variables != nullptr) {
      if (Entry* variable = variables->value.find(step.key)) {
        replace(*variable, o, step);
        return;
      }
    }
    for (const std::string& key : top_keys_) {
      if (key != step.key) continue;
      set(root_, o, step);
      return;
    }
    std::vector<std::string> known;
    if (variables != nullptr) {
      for (const Entry& e : variables->value.entries) known.push_back(e.key);
    }
    known.insert(known.end(), top_keys_.begin(), top_keys_.end());
    refuse(o, step, fmt::format("'{}' is neither a variable nor a section of the deck", step.key),
           suggestion(step.key, known));
  }

  void set(Node& map, const Override& o, const Step& step) {
    if (Entry* entry = map.find(step.key)) {
      replace(*entry, o, step);
    } else {
      map.entries.push_back({step.key, {o.name, 1, step.column}, o.value});
    }
  }

  void apply_path(const Override& o) {
    if (o.steps[0].key == "variables") {
      const Entry* variables = root_.find("variables");
      if (variables == nullptr || variables->value.find(o.steps[1].key) == nullptr) {
        std::vector<std::string> known;
        if (variables != nullptr) {
          for (const Entry& e : variables->value.entries) known.push_back(e.key);
        }
        refuse(o, o.steps[1], fmt::format("the deck has no variable '{}'", o.steps[1].key),
               suggestion(o.steps[1].key, known, "variables"));
        return;
      }
    }
    Node* node = &root_;
    for (std::size_t k = 0; k + 1 < o.steps.size() && node != nullptr; ++k) {
      node = child(*node, o, k);
    }
    if (node == nullptr) return;
    const Step& last = o.steps.back();
    if (last.index < 0 && node->kind == Node::Kind::map) {
      set(*node, o, last);
    } else if (Node* element = child(*node, o, o.steps.size() - 1)) {
      *element = o.value;
    }
  }

  /// The value that step k leads to, created when a mapping lacks it; nullptr after an error.
  Node* child(Node& node, const Override& o, std::size_t k) {
    const Step& step = o.steps[k];
    if (step.index >= 0) {
      if (node.kind != Node::Kind::list) {
        refuse(o, step, fmt::format("'{}' has no elements: it is {}", so_far(o, k), node.words()),
               {});
        return nullptr;
      }
      if (step.index < static_cast<int>(node.items.size())) {
        return &node.items[static_cast<std::size_t>(step.index)];
      }
      refuse(o, step, fmt::format("'{}' has only {} elements", so_far(o, k), node.items.size()),
             "elements count from 0");
      return nullptr;
    }
    if (node.kind == Node::Kind::list) {
      for (Node& item : node.items) {
        const Entry* name = item.find("name");
        if (name != nullptr && name->value.text == step.key) return &item;
      }
      const bool number = step.key.find_first_not_of("0123456789") == std::string::npos;
      refuse(o, step, fmt::format("'{}' has no element named '{}'", so_far(o, k), step.key),
             number ? fmt::format("an element by its number is written '{}[{}]'", so_far(o, k),
                                  step.key)
                    : suggestion(step.key, names_in(node), "names"));
      return nullptr;
    }
    if (node.kind == Node::Kind::null) node.kind = Node::Kind::map;
    if (node.kind == Node::Kind::scalar) {
      refuse(o, step, fmt::format("'{}' has no keys: it is {}", so_far(o, k), node.words()), {});
      return nullptr;
    }
    if (Entry* entry = node.find(step.key)) return &entry->value;
    // A key that does not exist is judged by the schema, at this place.
    Node created = Node::map();
    created.place = {o.name, 1, step.column};
    return &node.add(step.key, std::move(created));
  }

  static std::string so_far(const Override& o, std::size_t steps) {
    std::string path;
    for (std::size_t k = 0; k < steps; ++k) {
      const Step& s = o.steps[k];
      path = join_path(path, s.index >= 0 ? fmt::format("[{}]", s.index) : s.key);
    }
    return path.empty() ? "the deck" : path;
  }

  Node& root_;
  const std::vector<std::string>& top_keys_;
  Diagnostics& found_;
};

}  // namespace

void apply_overrides(Node& root, const std::vector<std::string>& overrides,
                     const std::vector<std::string>& top_keys, Diagnostics& found) {
  Overrider overrider(root, top_keys, found);
  int number = 0;
  for (const std::string& text : overrides) overrider.apply(text, ++number);
}

}  // namespace sphgeo
