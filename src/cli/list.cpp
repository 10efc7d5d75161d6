// `sphgeo list` and `sphgeo show`: what the registries hold, from the declarations themselves.

#include <fmt/format.h>

#include <array>
#include <iostream>

#include "cli/commands.h"
#include "core/error.h"
#include "core/text.h"
#include "deck/model.h"
#include "effects/effect.h"

namespace sphgeo {
namespace {

std::array<const RegistryCore*, 4> registries() {
  return {&Registry<MaterialSpec>::get(), &Registry<Shape>::get(), &Registry<BoundarySpec>::get(),
          &Registry<ProbeSpec>::get()};
}

/// A value on one line, as a deck may hold it.
std::string flow_text(const Node& node) {
  std::string out;
  switch (node.kind) {
    case Node::Kind::null:
      return "none";
    case Node::Kind::scalar:
      return node.text.empty() ? "''" : node.text;
    case Node::Kind::list:
      for (const Node& item : node.items) out += (out.empty() ? "" : ", ") + flow_text(item);
      return "[" + out + "]";
    case Node::Kind::map:
      for (const Entry& e : node.entries)
        out += (out.empty() ? "" : ", ") + e.key + ": " + flow_text(e.value);
      return "{" + out + "}";
  }
  return out;
}

/// The key, its sentence, and what else the declaration says: kind, range, default.
void print_key(const Key& key, const Node& defaults) {
  std::string facts = key.type().words(key);
  if (key.range().bounded()) facts += ", " + key.range().words(key.unit());
  if (const Entry* given = key.required() ? nullptr : defaults.find(key.name())) {
    const std::string value = flow_text(given->value);
    const bool with_unit = given->value.kind == Node::Kind::scalar && value != "auto" &&
                           !key.unit().same_dimension(unit::none);
    facts +=
        fmt::format("; default {}{}", value, with_unit ? std::string(" ") + key.unit().symbol : "");
  } else if (key.required()) {
    facts += "; required";
  }
  fmt::print("  {}\n      {}{}\n      {}\n", key.name(), key.sentence(),
             key.equation().empty() ? "" : " (" + key.equation() + ")", facts);
}

void print_type(const RegistryCore& registry, const RegistryEntry& entry) {
  const SchemaCore& own = entry.schema();
  const std::shared_ptr<void> object = entry.create();
  fmt::print("{} ({}): {}\n", entry.name, registry.interface_name(), own.sentence());
  std::vector<SchemaPart> parts;
  if (registry.common() != nullptr) parts.push_back({registry.common(), object.get()});
  parts.push_back({&own, entry.object(object.get())});
  Node defaults = Node::map();
  write_mapping(defaults, parts, {});
  for (const SchemaPart& part : parts)
    for (const Key& key : part.schema->keys()) print_key(key, defaults);
}

}  // namespace

int list_command() {
  const char* between = "";
  for (const RegistryCore* registry : registries()) {
    fmt::print("{}{} types:\n", between, registry->interface_name());
    for (const RegistryEntry& entry : registry->entries())
      fmt::print("  {:<22} {}\n", entry.name, entry.schema().sentence());
    between = "\n";
  }
  fmt::print("\neffects, selected by the scene:\n");
  for (const EffectRegistry::Entry& effect : EffectRegistry::all())
    fmt::print("  {:<22} {}\n", effect.info.name, effect.info.sentence);
  return 0;
}

int show_command(const std::string& type) {
  std::vector<std::string> names;
  const char* between = "";
  for (const RegistryCore* registry : registries()) {
    for (const std::string& name : registry->names()) names.push_back(name);
    if (const RegistryEntry* entry = registry->find(type)) {
      fmt::print("{}", between);
      print_type(*registry, *entry);
      between = "\n";
    }
  }
  if (*between != '\0') return 0;
  const std::string near = nearest_name(type, names);
  throw Error(ExitCode::usage,
              near.empty()
                  ? fmt::format("there is no type '{}'; 'sphgeo list' prints them all", type)
                  : fmt::format("there is no type '{}'; did you mean '{}'?", type, near));
}

}  // namespace sphgeo
