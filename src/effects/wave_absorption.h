#pragma once
// What a piston that takes up waves keeps from step to step.

#include <string>

#include "sph/world.h"

namespace sphgeo {

/// Its motion beside the one that the deck prescribes, along the direction of its waves; all zero
/// at first, saved and loaded.
struct PistonState {
  double& wanted;  ///< speed that would take up what comes, m/s
  double& lag;     ///< time in which it gets to that speed, s
  double& speed;   ///< m/s
  double& shift;   ///< m

  template <int Dim>
  PistonState(World<Dim>& world, const std::string& boundary)
      : wanted(world.kept(key(boundary, "wanted"))),
        lag(world.kept(key(boundary, "lag"))),
        speed(world.kept(key(boundary, "speed"))),
        shift(world.kept(key(boundary, "shift"))) {}
  static std::string key(const std::string& boundary, const std::string& name) {
    return "wave_absorption/" + boundary + "/" + name;
  }
};

}  // namespace sphgeo
