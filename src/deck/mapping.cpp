// Reading, writing and describing one mapping of the deck from its declared keys.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/text.h"
#include "deck/key.h"
#include "deck/scalar_reading.h"

namespace sphgeo {

namespace {

constexpr const char* note_prefix = "x-";

struct DeclaredKey {
  const Key* key;
  void* object;
};

std::vector<DeclaredKey> keys_of(const std::vector<SchemaPart>& parts) {
  std::vector<DeclaredKey> out;
  for (const SchemaPart& part : parts) {
    for (const Key& key : part.schema->keys()) out.push_back({&key, part.object});
  }
  return out;
}

std::string in_section(const std::string& path) { return path.empty() ? "" : " in " + path; }

}  // namespace

std::string DeckReading::folder_of(const std::string& file) const {
  if (file == main_file || file.rfind("--set", 0) == 0) return folder;
  return std::filesystem::path(file).parent_path().string();
}

bool Range::contains(double v) const {
  return (low_open ? v > low : v >= low) && (high_open ? v < high : v <= high);
}

bool Range::bounded() const { return std::isfinite(low) || std::isfinite(high); }

std::string Range::words(const Unit& u) const {
  const std::string symbol = u.same_dimension(unit::none) ? "" : fmt::format(" {}", u.symbol);
  const std::string from =
      fmt::format("{} {}{}", low_open ? "greater than" : "at least", exact(low), symbol);
  const std::string to =
      fmt::format("{} {}{}", high_open ? "less than" : "at most", exact(high), symbol);
  if (!std::isfinite(high)) return from;
  if (!std::isfinite(low)) return to;
  return from + " and " + to;
}

bool read_mapping(const Node& node, const std::vector<SchemaPart>& parts, const std::string& path,
                  DeckReading& reading, const std::vector<std::string>& extra) {
  if (node.kind != Node::Kind::map) {
    return wrong_kind(
        node, fmt::format("a mapping of the keys of '{}'", parts.back().schema->type_name()), path,
        reading);
  }
  const std::vector<DeclaredKey> declared = keys_of(parts);
  bool good = true;
  std::vector<const Entry*> unknown;
  for (const Entry& entry : node.entries) {
    if (entry.key.rfind(note_prefix, 0) == 0) continue;
    const std::string at = join_path(path, entry.key);
    reading.places[at] = entry.place;
    if (std::find(extra.begin(), extra.end(), entry.key) != extra.end()) continue;
    const auto found = std::find_if(declared.begin(), declared.end(), [&](const DeclaredKey& d) {
      return d.key->name() == entry.key;
    });
    if (found == declared.end()) {
      unknown.push_back(&entry);
      continue;
    }
    const Key& key = *found->key;
    good &= key.type().read(entry.value, key, at, reading, key.member_of(found->object));
  }

  // A misspelt key most likely stands for a key that is absent; a required one is then not reported
  // as missing.
  std::vector<std::string> absent, all;
  for (const DeclaredKey& d : declared) {
    all.push_back(d.key->name());
    if (node.find(d.key->name()) == nullptr) absent.push_back(d.key->name());
  }
  for (const SchemaPart& part : parts)
    for (std::vector<std::string>* names : {&absent, &all})
      names->insert(names->end(), part.schema->taken_before().begin(),
                    part.schema->taken_before().end());
  std::vector<std::string> meant;
  for (const Entry* entry : unknown) {
    std::string near = nearest_name(entry->key, absent);
    if (near.empty()) near = nearest_name(entry->key, all);
    // What stands behind a comma in {a: b, c} is a key: "1,5" or a sentence needs quotes.
    const bool behind_comma = entry->value.kind == Node::Kind::null && near.empty() &&
                              !entry->key.empty() &&
                              (std::isdigit(static_cast<unsigned char>(entry->key.front())) != 0 ||
                               entry->key.find(' ') != std::string::npos);
    reading.error(
        "E012", entry->place, path, fmt::format("unknown key '{}'{}", entry->key, in_section(path)),
        behind_comma   ? "a comma in braces begins a new key: put text with a comma in quotes, and "
                         "write numbers with a point"
        : near.empty() ? suggestion(entry->key, absent.empty() ? all : absent, "valid keys")
                       : fmt::format("did you mean '{}'?", near));
    meant.push_back(near);
    good = false;
  }
  for (const DeclaredKey& d : declared) {
    if (!d.key->required() || node.find(d.key->name()) != nullptr) continue;
    good = false;
    if (std::find(meant.begin(), meant.end(), d.key->name()) != meant.end()) continue;
    reading.error("E011", node.place, path,
                  fmt::format("missing key '{}'{}", d.key->name(), in_section(path)),
                  fmt::format("{}: {}", d.key->type().words(*d.key), d.key->sentence()));
  }

  for (const SchemaPart& part : parts) {
    for (const auto& rule : part.schema->rules()) {
      reading.rules.push_back([&reading, &rule, object = part.object, path] {
        CheckContext context(reading.found, reading.places, path, reading.dimension,
                             reading.resolution);
        rule(object, context);
      });
    }
  }
  return good;
}

void write_mapping(Node& out, const std::vector<SchemaPart>& parts, const WriteStyle& style) {
  for (const DeclaredKey& d : keys_of(parts)) {
    if (style.for_hash && d.key->is_changeable_on_resume()) continue;
    const void* member = d.key->member_of(static_cast<const void*>(d.object));
    Node value = d.key->type().write(member, style);
    if (value.kind != Node::Kind::null) out.add(d.key->name(), std::move(value));
  }
}

namespace {

/// A written value as JSON: numbers and booleans as such.
Json json_value(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return nullptr;
    case Node::Kind::list: {
      Json out = Json::array();
      for (const Node& item : node.items) out.push_back(json_value(item));
      return out;
    }
    case Node::Kind::map: {
      Json out = Json::object();
      for (const Entry& e : node.entries) out[e.key] = json_value(e.value);
      return out;
    }
    case Node::Kind::scalar:
      break;
  }
  if (node.quoted) return node.text;
  if (node.text == "true" || node.text == "false") return node.text == "true";
  const NumberText n = parse_number(node.text);
  if (n.status != NumberText::Status::number) return node.text;
  if (n.value == std::floor(n.value) && std::abs(n.value) < 1e15) {
    return static_cast<std::int64_t>(n.value);
  }
  return n.value;
}

}  // namespace

void json_mapping(Json& out, const std::vector<SchemaPart>& parts, Json& definitions) {
  out["type"] = "object";
  if (!out.contains("properties")) out["properties"] = Json::object();
  if (!out.contains("required")) out["required"] = Json::array();
  for (const DeclaredKey& d : keys_of(parts)) {
    const Key& key = *d.key;
    std::string text = key.sentence();
    if (!key.unit().same_dimension(unit::none)) text += fmt::format(" [{}]", key.unit().symbol);
    if (!key.equation().empty()) text += fmt::format(" ({})", key.equation());
    Json property = key.type().json(key, definitions);
    // Draft 7 ignores whatever stands beside a $ref.
    if (property.contains("$ref")) property = {{"allOf", Json::array({std::move(property)})}};
    property["description"] = text;
    if (!key.unit().same_dimension(unit::none)) property["x-unit"] = key.unit().symbol;
    if (key.required()) {
      out["required"].push_back(key.name());
    } else {
      const Node value = key.type().write(key.member_of(static_cast<const void*>(d.object)), {});
      // A section's default follows from those of its keys.
      const bool section = value.kind == Node::Kind::map && !value.entries.empty();
      if (value.kind != Node::Kind::null && !section) property["default"] = json_value(value);
    }
    out["properties"][key.name()] = std::move(property);
  }
  out["patternProperties"] = {{"^x-", Json::object()}};
  out["additionalProperties"] = false;
  if (out["required"].empty()) out.erase("required");
}

}  // namespace sphgeo
