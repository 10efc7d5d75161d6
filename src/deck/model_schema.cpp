// The top level of the deck: its sections, and the rules that hold between them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_set>
#include <utility>

#include "core/hash.h"
#include "core/text.h"
#include "deck/around.h"
#include "deck/copies.h"
#include "deck/model.h"
#include "deck/yaml_reader.h"
#include "deck/yaml_writer.h"

namespace sphgeo {

namespace {

/// A key path and the name that stands there.
using Named = std::pair<std::string, std::string>;

template <class List, class NameOf>
void collect(std::vector<Named>& out, const char* section, const List& list, NameOf name_of) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    out.emplace_back(fmt::format("{}[{}].name", section, k), name_of(list[k]));
  }
}

/// Names become parts of file names and key paths, and must be unique.
void check_names(const std::vector<Named>& named, const std::string& what, CheckContext& c) {
  const auto fits = [](char l) {
    return (l >= 'a' && l <= 'z') || (l >= 'A' && l <= 'Z') || (l >= '0' && l <= '9') || l == '_' ||
           l == '-';
  };
  constexpr std::size_t longest = 100;  // with its ending it must fit a file system's 255 bytes
  std::unordered_set<std::string> seen;
  for (const auto& [path, name] : named) {
    if (name.size() > longest)
      c.error(path, fmt::format("a name of {} characters", name.size()),
              fmt::format("at most {} characters", longest), "E024");
    else if (name.empty() || !std::all_of(name.begin(), name.end(), fits)) {
      c.error(path, fmt::format("'{}' cannot be used as a name", name),
              "use letters, digits, '_' and '-'", "E024");
    }
    if (!seen.insert(name).second)
      c.error(path, fmt::format("the name '{}' is used twice", name),
              fmt::format("{} need different names", what), "E022");
  }
}

void check_references(const Model& m, CheckContext& c) {
  std::vector<std::string> materials, probes;
  for (const auto& material : m.materials) materials.push_back(material->name);
  for (std::size_t k = 0; k < m.probes.size(); ++k) {
    probes.push_back(m.probes[k]->name);
    if (m.probes[k]->name == relaxation_probe)
      c.error(fmt::format("probes[{}].name", k),
              fmt::format("a probe cannot be called '{}'", relaxation_probe),
              "'expect' uses this name for the history of the relaxation", "E024");
  }
  for (std::size_t k = 0; k < m.bodies.size(); ++k) {
    if (m.material(m.bodies[k].material) != nullptr) continue;
    c.error(fmt::format("bodies[{}].material", k),
            fmt::format("there is no material '{}'", m.bodies[k].material),
            suggestion(m.bodies[k].material, materials, "materials"), "E021");
  }
  for (std::size_t k = 0; k < m.expect.size(); ++k) {
    const std::string probe = m.expect[k].probe.substr(0, m.expect[k].probe.find('.'));
    if (probe == relaxation_probe) continue;
    if (std::find(probes.begin(), probes.end(), probe) != probes.end()) continue;
    c.error(fmt::format("expect[{}].probe", k), fmt::format("there is no probe '{}'", probe),
            suggestion(probe, probes, "probes"), "E021");
  }
}

/// All water of a scene is one liquid: its density, viscosity and speed of sound are those of one
/// material. A second one that nothing is made of does no harm.
void check_one_liquid(const Model& m, CheckContext& c) {
  const MaterialSpec* liquid = m.liquid();
  for (std::size_t k = 0; k < m.materials.size(); ++k) {
    const MaterialSpec& material = *m.materials[k];
    if (&material == liquid || material.phase() != "water") continue;
    if (std::any_of(m.bodies.begin(), m.bodies.end(),
                    [&](const Body& b) { return b.material == material.name; }))
      c.error(fmt::format("materials[{}]", k),
              fmt::format("'{}' is a second liquid beside '{}': a scene has one", material.name,
                          liquid->name),
              "give all water bodies one material", "E025");
  }
}

void check_all(Model& m, CheckContext& c) {
  std::vector<Named> materials, sets, probes, results;
  const auto of_pointer = [](const auto& p) { return p->name; };
  const auto of_value = [](const auto& v) { return v.name; };
  collect(materials, "materials", m.materials, of_pointer);
  collect(sets, "bodies", m.bodies, of_value);
  collect(sets, "boundaries", m.boundaries, of_pointer);
  collect(probes, "probes", m.probes, of_pointer);
  collect(results, "expect", m.expect, of_value);
  check_names(materials, "materials", c);
  check_names(sets, "bodies and boundaries", c);
  check_names(probes, "probes", c);
  check_names(results, "expected results", c);
  check_references(m, c);
  check_one_liquid(m, c);
  if (m.dimension == 2 && m.gravity.y() != 0.0) m.gravity.y() = 0.0;
}

}  // namespace

const MaterialSpec* Model::liquid() const {
  const MaterialSpec* first = nullptr;
  for (const auto& m : materials) {
    if (m->phase() != "water") continue;
    if (!first) first = m.get();
    for (const Body& b : bodies)
      if (b.material == m->name) return m.get();
  }
  return first;
}

Schema<Model> Model::schema() {
  Schema<Model> s("deck", "A scene, its probes, and its expected results.");
  s.optional("title", &Model::title, unit::none, "what the deck shows").changeable_on_resume();
  s.required("dimension", &Model::dimension, unit::none, "2 (the x-z plane) or 3")
      .at_least(2)
      .at_most(3);
  s.required("resolution", &Model::resolution, unit::length, "particle spacing dp").above(0);
  s.optional("gravity", &Model::gravity, unit::acceleration,
             "a magnitude, pointing along -z, or a vector [x, y, z]")
      .downward();
  s.optional("body_force", &Model::body_force, unit::acceleration,
             "acceleration field of x, y, z and t on top of gravity");
  s.required("end_time", &Model::end_time, unit::time, "simulated time at which the run ends")
      .above(0)
      .changeable_on_resume();
  s.optional("variables", &Model::variables, unit::none,
             "numbers that formulas may use; each may use those before it");
  s.optional("include", &Model::include, unit::none,
             "deck files whose sections are merged into this one, relative to this file")
      .changeable_on_resume();
  s.required("materials", &Model::materials, unit::none, "what bodies are made of").items(1, 1000);
  s.optional("bodies", &Model::bodies, unit::none, "regions filled with particles").items(0, 10000);
  s.optional("boundaries", &Model::boundaries, unit::none, "walls and other borders of the scene")
      .items(0, 1000);
  s.optional("probes", &Model::probes, unit::none, "what is measured while the scene runs")
      .items(0, 10000);
  s.optional("output", &Model::output, unit::none, "frames and tables").changeable_on_resume();
  s.optional("numerics", &Model::numerics, unit::none, "choices of the numerical method");
  s.optional("without", &Model::without, unit::none,
             "effects that are switched off, to study their influence; 'sphgeo show EFFECT' states "
             "whether it can be");
  s.optional("relaxation", &Model::relaxation, unit::none, "initial distribution of pore water");
  s.optional("expect", &Model::expect, unit::none, "results the deck claims")
      .items(0, 10000)
      .changeable_on_resume();
  s.check(check_all);
  return s;
}

namespace {

Node resolved_tree(const Model& model, const WriteStyle& style) {
  Node out = Node::map();
  write_mapping(out, {{&schema_of<Model>(), const_cast<Model*>(&model)}}, style);
  std::erase_if(out.entries, [](const Entry& e) { return e.key == "include"; });  // merged already
  return out;
}

}  // namespace

std::string resolved_yaml(const Model& model) {
  return "# The deck as it was run: included files merged, overrides applied, all defaults filled "
         "in.\n" +
         write_yaml(resolved_tree(model, {}));
}

std::string decisive_yaml(const Model& model) {
  WriteStyle style;
  style.for_hash = true;
  return write_yaml(resolved_tree(model, style));
}

std::string deck_hash(const Model& model) {
  return fmt::format("{:016x}", fnv1a(decisive_yaml(model)));
}

namespace {

void flatten(const Node& node, const std::string& path, std::map<std::string, std::string>& out) {
  switch (node.kind) {
    case Node::Kind::null:
      out[path] = "nothing";
      break;
    case Node::Kind::scalar:
      out[path] = node.text;
      break;
    case Node::Kind::list:
      for (std::size_t k = 0; k < node.items.size(); ++k)
        flatten(node.items[k], fmt::format("{}[{}]", path, k), out);
      break;
    case Node::Kind::map:
      for (const Entry& e : node.entries) flatten(e.value, join_path(path, e.key), out);
      break;
  }
}

}  // namespace

std::vector<std::string> differing_keys(const std::string& there, const std::string& here) {
  std::map<std::string, std::string> values[2];
  const std::string* texts[2] = {&there, &here};
  for (int k = 0; k < 2; ++k) {
    Diagnostics ignored;
    if (const auto tree = read_yaml(*texts[k], "deck", ignored)) flatten(*tree, "", values[k]);
  }
  std::vector<std::string> out;
  const auto value = [](const std::map<std::string, std::string>& from, const std::string& path) {
    const auto it = from.find(path);
    return it == from.end() ? std::string("nothing") : it->second;
  };
  std::set<std::string> paths;
  for (const auto& side : values)
    for (const auto& [path, text] : side) paths.insert(path);
  for (const std::string& path : paths)
    if (value(values[0], path) != value(values[1], path))
      out.push_back(fmt::format("{}: {} there, {} here", path, value(values[0], path),
                                value(values[1], path)));
  return out;
}

Json json_schema() {
  Json out{{"$schema", "http://json-schema.org/draft-07/schema#"},
           {"title", "sphgeo deck"},
           {"description", schema_of<Model>().sentence()}};
  Json definitions = Json::object();
  Model defaults;
  json_mapping(out, {{&schema_of<Model>(), &defaults}}, definitions);
  // `copies` and `around` are expanded before bodies are read, and are not among their keys.
  Copies copies;
  Json& many = out["properties"]["bodies"]["items"]["properties"]["copies"];
  json_mapping(many, {{&schema_of<Copies>(), &copies}}, definitions);
  many["description"] = schema_of<Copies>().sentence();
  out["properties"]["bodies"]["items"]["properties"]["around"] = {
      {"type", "array"}, {"items", {{"type", "string"}}}, {"description", around_sentence}};
  out["definitions"] = std::move(definitions);
  return out;
}

}  // namespace sphgeo
