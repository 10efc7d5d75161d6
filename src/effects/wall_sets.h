#pragma once
// What water and soil meet as walls: the walls themselves, and the interface of solids.

#include <memory>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "effects/wall_packing.h"

namespace sphgeo {

/// The sets that act as walls in a scene: "walls", "interface".
template <int Dim>
std::vector<std::string> wall_sets(const World<Dim>& world) {
  std::vector<std::string> names;
  for (const char* name : {"walls", "interface"})
    if (world.find(name)) names.emplace_back(name);
  return names;
}

/// Adds to the needs of an effect on `target` that it sums over the volumes of the walls around it.
template <int Dim>
void need_wall_volumes(Needs& needs, const std::string& target,
                       const std::vector<std::string>& walls) {
  for (const std::string& set : walls) {
    needs.record<Position<Dim>>(set, Access::read);
    needs.record<packed::Wall<Dim>>(set, Access::read, packed::Wall<Dim>::volume);
    needs.lists.push_back({target, set});
  }
}

/// One effect of kind E, made from the world and the name of the set, for each set of walls that
/// meets `target`.
template <class E, int Dim>
Binding<Dim> bind_walls(const World<Dim>& world, const std::string& target) {
  if (!world.find(target)) return {"there is no " + target};
  Binding<Dim> binding("there are no walls and no solids");
  for (const std::string& set : wall_sets(world)) {
    binding.effects.push_back(std::make_unique<E>(world, set));
    binding.because =
        "there are " + target + " and " +
        (set == "interface" ? (binding.effects.size() > 1 ? "walls and solids" : "solids")
                            : "walls");
  }
  return binding;
}

/// How `acts_on` names what is near a set of walls.
inline std::string near_walls(const std::string& target, const std::string& walls) {
  return target + (walls == "interface" ? " near solids" : " near walls");
}

}  // namespace sphgeo
