#include "run/wishes.h"

#include <algorithm>

#include "probes/probe.h"

namespace sphgeo {

std::vector<std::string> usual_fields(const std::string& set, bool mixed) {
  if (set.starts_with("solids")) return {"velocity", "cauchy_stress", "von_mises", "part"};
  if (set != "water" && set != "soil") return {"velocity", "normal", "part"};
  std::vector<std::string> names{"velocity", "pressure", "density", "surface", "part"};
  if (set == "soil")
    names = {"velocity", "stress", "pressure", "plastic_strain", "volume_fraction", "part"};
  if (mixed && set == "water") names.insert(names.end(), {"volume", "water_fraction"});
  if (mixed && set == "soil") names.push_back("pore_pressure");
  return names;
}

std::vector<Wish> wishes_of(const Model& model, const std::vector<std::string>& sets) {
  const auto present = [&](const std::string& s) {
    return std::find(sets.begin(), sets.end(), s) != sets.end();
  };
  std::vector<Wish> wishes;
  for (const auto& p : model.probes)
    for (const FieldRequest& r : dynamic_cast<const Probe&>(*p).needs(model))
      if (present(r.set)) wishes.push_back({r.set, r.field->name, "probe " + p->name, r.optional});
  for (const std::string& set : sets)
    if (set != "walls" && set != "interface")
      for (const auto& asked = model.output.frames.fields;
           const std::string& f :
           asked.empty() ? usual_fields(set, present("water") && present("soil")) : asked)
        wishes.push_back({set, f, "frames", true});  // a set without that field shows the others
  if (present("water")) wishes.push_back({"water", "pressure", "run.csv"});
  if (present("soil")) wishes.push_back({"soil", "volume", "run.csv"});
  for (const std::string& set : sets)
    if (set.starts_with("solids"))
      wishes.push_back({set, "strain_energy", "run.csv", true});  // none of rigid ones
  return wishes;
}

}  // namespace sphgeo
