#include "cli/catalog.h"

#include <fmt/format.h>

#include <functional>

#include "deck/around.h"
#include "deck/copies.h"
#include "deck/model.h"
#include "deck/motion.h"
#include "effects/effect.h"
#include "particles/fields.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

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

KeyFacts facts_of(const Key& key, const Node& defaults) {
  KeyFacts f{key.name(),
             key.sentence(),
             key.equation(),
             key.type().words(key),
             "",
             key.required(),
             key.is_changeable_on_resume()};
  if (key.range().bounded()) f.accepts += ", " + key.range().words(key.unit());
  if (key.required()) return f;
  if (const Entry* given = defaults.find(key.name())) {
    f.otherwise = flow_text(given->value);
    const bool with_unit = given->value.kind == Node::Kind::scalar && f.otherwise != "auto" &&
                           !key.unit().same_dimension(unit::none);
    if (with_unit) f.otherwise += std::string(" ") + key.unit().symbol;
  }
  return f;
}

CatalogEntry entry_of(const std::string& name, const std::string& sentence,
                      const std::vector<SchemaPart>& parts) {
  CatalogEntry e{name, sentence, {}, {}};
  Node defaults = Node::map();
  write_mapping(defaults, parts, {});
  for (const SchemaPart& part : parts)
    for (const Key& key : part.schema->keys()) e.keys.push_back(facts_of(key, defaults));
  return e;
}

template <class P>
CatalogEntry section() {
  P object;
  const SchemaCore& schema = schema_of<P>();
  CatalogEntry e = entry_of(schema.type_name(), schema.sentence(), {{&schema, &object}});
  // The default of a section are the defaults of its own keys, which are listed there.
  for (KeyFacts& k : e.keys)
    if (k.otherwise.starts_with('{') && k.otherwise != "{}") k.otherwise.clear();
  return e;
}

CatalogGroup types(const RegistryCore& registry, const std::string& heading,
                   const std::string& sentence) {
  CatalogGroup g{registry.interface_name(), heading, sentence, {}};
  for (const RegistryEntry& type : registry.entries()) {
    const std::shared_ptr<void> object = type.create();
    std::vector<SchemaPart> parts;
    if (registry.common() != nullptr) parts.push_back({registry.common(), object.get()});
    parts.push_back({&type.schema(), type.object(object.get())});
    g.entries.push_back(entry_of(type.name, type.schema().sentence(), parts));
  }
  return g;
}

CatalogGroup probes() {
  const RegistryCore& registry = Registry<ProbeSpec>::get();
  CatalogGroup g = types(registry, "probes",
                         "Measurements during a run: entries of `probes`. Their columns are those "
                         "in 3D, after the time; in 2D amounts are per metre of depth, and vectors "
                         "have no y.");
  const Model defaults;
  for (std::size_t k = 0; k < g.entries.size(); ++k) {
    const std::shared_ptr<void> object = registry.entries()[k].create();
    if (const auto* probe = dynamic_cast<const Probe*>(static_cast<ProbeSpec*>(object.get())))
      g.entries[k].columns = probe->columns(defaults);
  }
  return g;
}

CatalogGroup effects() {
  CatalogGroup g{"effect",
                 "effects",
                 "Terms of the equations, selected by the contents of the scene. `check --explain` "
                 "shows which of them a deck uses.",
                 {}};
  for (const EffectRegistry::Entry& e : EffectRegistry::all())
    g.entries.push_back(
        {e.info.name,
         e.info.sentence,
         {},
         {{"stage", stage_name(e.info.stage)},
          {"equations", e.info.equations},
          {"runs", e.info.supporting ? "when an effect, a probe or a frame reads what it computes"
                                     : "when the scene has what it acts on"},
          {"without it", e.info.when_off.empty() ? "cannot be switched off" : e.info.when_off}}});
  return g;
}

CatalogGroup fields_group() {
  constexpr const char* types[] = {"a number", "a vector", "a symmetric tensor", "a whole number",
                                   "a whole number"};
  static_assert(std::size(types) == static_cast<std::size_t>(FieldType::identity) + 1);
  constexpr const char* lifetimes[] = {"state: evolves, is saved",
                                       "reference: fixed at t = 0, is saved",
                                       "derived: computed when something reads it"};
  CatalogGroup g{
      "field",
      "fields",
      "Values of each particle, by the names that `output.frames.fields` and frames use.",
      {}};
  for (const FieldSpec* f : fields::all)
    g.entries.push_back({f->name,
                         f->sentence,
                         {},
                         {{"unit", f->unit.symbol},
                          {"kind", types[static_cast<int>(f->type)]},
                          {"lifetime", lifetimes[static_cast<int>(f->lifetime)]}}});
  return g;
}

}  // namespace

std::vector<CatalogGroup> catalog() {
  // Expanded before bodies are read, and therefore not among their declared keys.
  CatalogEntry body = section<Body>();
  body.keys.push_back(
      {"copies", "makes many bodies of this one", "", "a mapping of the keys of 'copies'", "none"});
  body.keys.push_back({"around", around_sentence, "", "a list of names of bodies", "none"});
  return {{"section",
           "deck sections",
           "The keys of the deck and of the mappings in it.",
           {section<Model>(), body, section<Copies>(), section<Motion>(), section<Waves>(),
            section<Output>(), section<Frames>(), section<Numerics>(), section<Relaxation>(),
            section<Expect>()}},
          types(Registry<MaterialSpec>::get(), "materials",
                "What bodies are made of: entries of `materials`."),
          types(Registry<Shape>::get(), "shapes", "Regions of space, for bodies and walls."),
          types(Registry<BoundarySpec>::get(), "boundaries",
                "Boundaries of the scene: entries of `boundaries`."),
          probes(),
          effects(),
          fields_group()};
}

}  // namespace sphgeo
