#pragma once
// Number of threads that a scene can use.

#include "sph/world.h"

namespace sphgeo {

/// Particles of all sets but walls.
template <int Dim>
Index moving_particles(const World<Dim>& world) {
  Index sum = 0;
  for (const auto& set : world.sets())
    if (set->phase() != "wall") sum += set->size();
  return sum;
}

/// `asked`, or when that is 0 as many as the machine has, but no more than one per 2000 particles.
int sensible_threads(long particles, int asked);

}  // namespace sphgeo
