#pragma once
// How effects let particles in and out of a scene.

#include <string>
#include <vector>

#include "effects/effect.h"
#include "sph/parameters.h"

namespace sphgeo {

/// Position and velocity of a new particle.
template <int Dim>
struct InsertedParticle {
  Vec<Dim> position, velocity;
};

/// Appends particles of water of the density at rest under `depth_pressure` [Pa] to the set, and
/// enters them into the flux account of the boundary.
template <int Dim>
void insert_particles(World<Dim>& world, ParticleSet<Dim>& water, const std::string& boundary,
                      const std::vector<InsertedParticle<Dim>>& inserted, double pressure = 0) {
  if (inserted.empty()) return;
  const double density = world.parameters().water.density, c = world.parameters().water.sound_speed;
  const double mass = density * std::pow(water.spacing(), Dim);
  Exchanged<Dim>& account = world.exchanged(boundary);
  const Index first = water.append(static_cast<Index>(inserted.size()));
  for (std::size_t k = 0; k < inserted.size(); ++k) {
    const Index i = first + static_cast<Index>(k);
    water.tag(fields::part)[i] = -1;  // of no body
    water.vector(fields::position)[i] = inserted[k].position;
    water.vector(fields::velocity)[i] = inserted[k].velocity;
    water.scalar(fields::mass)[i] = mass;
    water.scalar(fields::density)[i] = density + pressure / (c * c);
    account.entered += 1;
    account.add(1, mass, inserted[k].position, inserted[k].velocity, world.gravity());
  }
}

/// One instance of an effect for each of the boundaries, which its constructor takes.
template <template <int> class E, int Dim, class B>
Binding<Dim> bind_exchange(const std::vector<B>& boundaries, const std::string& what) {
  Binding<Dim> binding("there is no " + what);
  for (const B& boundary : boundaries) {
    binding.effects.push_back(std::make_unique<E<Dim>>(boundary));
    binding.because = "boundary '" + boundary.name + "' is " + what;
  }
  return binding;
}

}  // namespace sphgeo
