#pragma once
// How long an acoustic step may be beside elastic solids that are lighter than what touches them.

#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/soil_phase.h"
#include "effects/solid_phase.h"

namespace sphgeo {

/// Bound of the acoustic step by elastic bodies of a set of solids, s; endless where there are none, or neither water nor soil.
///
/// Water and soil act on a solid with the pressure of one acoustic step through all of the step. On the layer of the body that they reach, as thick as a
/// spacing or as the body, that pressure is a spring and a mass: L = rho dp / (rho_body thickness) compares the masses, and a step that is too
/// long feeds the body energy. Measured for plates with water or sand on both sides, of 1/4 to 4 times the density of
/// water, 1 to 2 spacings thick, of layers of half a spacing and one: with water the CFL number (Eq. 92) may be 0.22 / L, with soil 0.27 / L;
/// at 1.5 times as much they shake.
template <int Dim>
double step_beside_light_solids(const World<Dim>& world, const std::string& set_name) {
  const ParticleSet<Dim>& set = world.set(set_name);
  const SolidParts parts(world);
  const auto& part = set.tag(fields::part);
  const auto& reference = set.vector(fields::reference_position);
  struct Medium {
    double density, spacing, cfl, crossing;  // crossing: h / c
  };
  std::vector<Medium> media;
  if (const ParticleSet<Dim>* water = world.find("water")) {
    const WaterConstants w = WaterConstants::of(world);
    media.push_back({w.density, water->spacing(), 0.22, water->smoothing_length() / w.sound_speed});
  }
  if (const ParticleSet<Dim>* soil = world.find("soil")) {
    const SoilParts soils(world);
    double density = 0;
    for (const SoilPart& s : soils.of)
      if (s.moves) density = std::max(density, s.density);
    if (soils.deformable) media.push_back({density, soil->spacing(), 0.27, soil->smoothing_length() / soils.fastest_wave});
  }
  double bound = std::numeric_limits<double>::infinity(), coarsest = 0;
  for (const Medium& m : media) coarsest = std::max(coarsest, m.spacing);
  for (std::size_t b = 0; b < parts.of.size(); ++b) {
    if (!parts.of[b].elastic || solid_set_of(world.model(), b) != set_name) continue;
    // Half the body is as thick as its innermost particle is deep.
    double thickness = set.spacing();
    const Shape& shape = *world.model().bodies[b].shape;
    for (Index i = 0; i < set.size() && thickness < coarsest; ++i)
      if (part[i] == static_cast<std::int32_t>(b))
        thickness = std::max(thickness, set.spacing() - 2 * shape.signed_distance(to_space<Dim>(reference[i])));
    for (const Medium& m : media) {
      const double lightness = m.density * m.spacing / (parts.of[b].elastic->density * std::min(thickness, m.spacing));
      bound = std::min(bound, m.cfl * m.crossing / lightness);
    }
  }
  return bound;
}

}  // namespace sphgeo
