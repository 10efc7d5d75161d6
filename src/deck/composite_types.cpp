// How lists, optional values, nested sections and types chosen by `type:` are read and written.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/text.h"
#include "deck/scalar_reading.h"
#include "deck/schema.h"

namespace sphgeo {

namespace {

class ListType final : public ValueType {
 public:
  explicit ListType(ListHooks hooks) : hooks_(hooks) {}

  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    if (node.kind != Node::Kind::list) return wrong_kind(node, words(key), path, reading);
    const auto count = static_cast<int>(node.items.size());
    if (count < key.least_items() || count > key.most_items()) {
      reading.error(
          "E020", node.place, path, fmt::format("expected {}, got {}", words(key), node.words()),
          key.least_items() == key.most_items()
              ? fmt::format("it needs exactly {}", key.least_items())
          : count < key.least_items() ? fmt::format("it needs at least {}", key.least_items())
                                      : fmt::format("it takes at most {}", key.most_items()));
      return false;
    }
    hooks_.resize(out, node.items.size());  // once: rules keep the addresses of the elements
    bool good = true;
    for (std::size_t k = 0; k < node.items.size(); ++k) {
      const std::string at = fmt::format("{}[{}]", path, k);
      reading.places[at] = node.items[k].place;
      good &= hooks_.element().read(node.items[k], key, at, reading, hooks_.at(out, k));
    }
    return good;
  }
  Node write(const void* value, const WriteStyle& style) const override {
    Node out = Node::list();
    for (std::size_t k = 0; k < hooks_.size(value); ++k) {
      out.items.push_back(hooks_.element().write(hooks_.at(const_cast<void*>(value), k), style));
    }
    return out;
  }
  Json json(const Key& key, Json& definitions) const override {
    Json out{{"type", "array"}, {"items", hooks_.element().json(key, definitions)}};
    if (key.least_items() > 0) out["minItems"] = key.least_items();
    if (key.most_items() < std::numeric_limits<int>::max()) out["maxItems"] = key.most_items();
    return out;
  }
  std::string words(const Key& key) const override {
    return "a list, each element " + hooks_.element().words(key);
  }

 private:
  ListHooks hooks_;
};

class OptionalType final : public ValueType {
 public:
  explicit OptionalType(OptionalHooks hooks) : hooks_(hooks) {}

  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    if (node.kind == Node::Kind::scalar && node.text == "auto" && !node.quoted) {
      hooks_.reset(out);
      return true;
    }
    if (hooks_.element().read(node, key, path, reading, hooks_.emplace(out))) return true;
    hooks_.reset(out);
    return false;
  }
  Node write(const void* value, const WriteStyle& style) const override {
    if (!hooks_.has_value(value)) return Node::scalar("auto");
    return hooks_.element().write(hooks_.get(value), style);
  }
  Json json(const Key& key, Json& definitions) const override {
    return {
        {"anyOf", Json::array({hooks_.element().json(key, definitions), Json{{"const", "auto"}}})}};
  }
  std::string words(const Key& key) const override { return hooks_.element().words(key); }

 private:
  OptionalHooks hooks_;
};

class StructType final : public ValueType {
 public:
  explicit StructType(StructHooks hooks) : hooks_(hooks) {}

  bool read(const Node& node, const Key&, const std::string& path, DeckReading& reading,
            void* out) const override {
    return read_mapping(node, {{&hooks_.schema(), out}}, path, reading);
  }
  Node write(const void* value, const WriteStyle& style) const override {
    Node out = Node::map();
    write_mapping(out, {{&hooks_.schema(), const_cast<void*>(value)}}, style);
    return out;
  }
  Json json(const Key&, Json& definitions) const override {
    const std::shared_ptr<void> defaults = hooks_.create();
    Json out = Json::object();
    json_mapping(out, {{&hooks_.schema(), defaults.get()}}, definitions);
    return out;
  }
  std::string words(const Key&) const override {
    return fmt::format("a mapping of the keys of '{}'", hooks_.schema().type_name());
  }

 private:
  StructHooks hooks_;
};

/// The keys common to an interface (if any) and those of one of its types.
std::vector<SchemaPart> parts_of(const RegistryCore& registry, const RegistryEntry& entry,
                                 void* face) {
  std::vector<SchemaPart> parts;
  if (registry.common() != nullptr) parts.push_back({registry.common(), face});
  parts.push_back({&entry.schema(), entry.object(face)});
  return parts;
}

class PolymorphicType final : public ValueType {
 public:
  explicit PolymorphicType(PolymorphicHooks hooks) : hooks_(hooks) {}

  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    const RegistryCore& registry = hooks_.registry();
    if (node.kind != Node::Kind::map) return wrong_kind(node, words(key), path, reading);
    const RegistryEntry* entry = entry_of(node, path, reading);
    if (entry == nullptr) return false;  // its keys cannot be checked: no further errors
    std::shared_ptr<void> face = entry->create();
    hooks_.type_name(face.get()) = entry->name;
    const bool good =
        read_mapping(node, parts_of(registry, *entry, face.get()), path, reading, {"type"});
    hooks_.assign(out, std::move(face));
    return good;
  }
  Node write(const void* value, const WriteStyle& style) const override {
    void* face = const_cast<void*>(hooks_.get(value));
    if (face == nullptr) return {};
    const std::string& type = hooks_.type_name(face);
    Node out = Node::map();
    out.add("type", Node::scalar(type));
    if (const RegistryEntry* entry = hooks_.registry().find(type)) {
      write_mapping(out, parts_of(hooks_.registry(), *entry, face), style);
    }
    return out;
  }
  Json json(const Key&, Json& definitions) const override {
    const RegistryCore& registry = hooks_.registry();
    const Json reference{{"$ref", "#/definitions/" + registry.interface_name()}};
    if (definitions.contains(registry.interface_name())) return reference;
    definitions[registry.interface_name()] =
        Json::object();  // stops the recursion of types that contain their own kind
    Json types = Json::array();
    for (const RegistryEntry& entry : registry.entries()) {
      const std::shared_ptr<void> face = entry.create();
      Json type{{"title", entry.name}, {"description", entry.schema().sentence()}};
      type["properties"]["type"] = {{"const", entry.name},
                                    {"description", entry.schema().sentence()}};
      type["required"] = Json::array({"type"});
      json_mapping(type, parts_of(registry, entry, face.get()), definitions);
      types.push_back(std::move(type));
    }
    if (!types.empty()) definitions[registry.interface_name()] = {{"oneOf", std::move(types)}};
    return reference;
  }
  std::string words(const Key&) const override {
    return fmt::format("a {}: a mapping with a 'type'", hooks_.registry().interface_name());
  }

 private:
  const RegistryEntry* entry_of(const Node& node, const std::string& path,
                                DeckReading& reading) const {
    const RegistryCore& registry = hooks_.registry();
    const Entry* type = node.find("type");
    if (type == nullptr) {
      report_missing_type(node, path, reading);
      return nullptr;
    }
    const std::string at = join_path(path, "type");
    reading.places[at] = type->place;
    const std::string expected = fmt::format("a type of {}", registry.interface_name());
    if (type->value.kind != Node::Kind::scalar) {
      wrong_kind(type->value, expected, at, reading);
      return nullptr;
    }
    const RegistryEntry* entry = registry.find(type->value.text);
    if (entry == nullptr) {
      reading.error(
          "E016", type->value.place, at,
          fmt::format("unknown {} type {}", registry.interface_name(), type->value.words()),
          suggestion(type->value.text, registry.names(), "valid types"));
    }
    return entry;
  }

  void report_missing_type(const Node& node, const std::string& path, DeckReading& reading) const {
    const RegistryCore& registry = hooks_.registry();
    for (const Entry& e : node.entries) {
      if (nearest_name(e.key, {"type"}).empty()) continue;
      reading.error("E012", e.place, path, fmt::format("unknown key '{}' in {}", e.key, path),
                    "did you mean 'type'?");
      return;
    }
    reading.error("E011", node.place, path, fmt::format("missing key 'type' in {}", path),
                  fmt::format("it chooses the {}: {}", registry.interface_name(),
                              in_words(registry.names(), "or")));
  }

  PolymorphicHooks hooks_;
};

}  // namespace

std::unique_ptr<const ValueType> make_list_type(ListHooks hooks) {
  return std::make_unique<ListType>(hooks);
}
std::unique_ptr<const ValueType> make_optional_type(OptionalHooks hooks) {
  return std::make_unique<OptionalType>(hooks);
}
std::unique_ptr<const ValueType> make_struct_type(StructHooks hooks) {
  return std::make_unique<StructType>(hooks);
}
std::unique_ptr<const ValueType> make_polymorphic_type(PolymorphicHooks hooks) {
  return std::make_unique<PolymorphicType>(hooks);
}

}  // namespace sphgeo
