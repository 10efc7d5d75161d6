#pragma once
// How long an acoustic step may be beside solids that are lighter than what touches them.

#include <algorithm>
#include <cmath>
#include <limits>

#include "deck/interfaces.h"
#include "effects/soil_phase.h"
#include "effects/solid_phase.h"

namespace sphgeo {

/// Bound of the acoustic step by the bodies of a set of solids, s; endless where there is neither
/// water nor soil.
///
/// Water and soil act on a solid with the pressure of one acoustic step through all of the step.
/// Together with the layer of the body that they reach, as thick as a spacing or as the body, they
/// are a spring of rho c^2 / dp and a mass of rho_body thickness, taken forward explicitly: with L
/// = rho dp / (rho_body thickness), dt may be of the order of dp / (c sqrt(L)). Measured for plates
/// of 1/30 to 2 times the density of water, 1 to 4 spacings thick, of layers of a quarter of a
/// spacing to one, with water or sand on both sides: 1.2 dp / (c sqrt(L)) holds for all, and at 1.6
/// the first breaks. A rigid body moves as a whole: its thickness is its smallest extent.
///
/// A plate also vibrates through its thickness. Coupling steps near half of that period, or a
/// little shorter, are unstable, as in any scheme of two time steps: seen for a
/// plate of two layers with L of 4.7 in sand, at 3 steps to the period. So beside bodies with L
/// above 2 the acoustic step is at most 1.5 of their own.
///
/// (Where water and soil are compressed by the mean velocity of a solid in the step before, as in
/// the paper, the spring is one and a half steps late, and only radiation damps what that feeds to
/// it: dt has to be below 0.4 dp / (c L), and plates shake long before.)
template <int Dim>
double step_beside_light_solids(const World<Dim>& world, const std::string& set_name) {
  const ParticleSet<Dim>& set = world.set(set_name);
  const SolidParameters& parts = world.parameters().solids;
  const auto& part = set.tag(fields::part);
  const auto& reference = set.vector(fields::reference_position);
  struct Medium {
    double density, spacing, sound;
  };
  std::vector<Medium> media;
  if (const ParticleSet<Dim>* water = world.find("water")) {
    const WaterParameters& w = world.parameters().water;
    media.push_back({w.density, water->spacing(), w.sound_speed});
  }
  if (const ParticleSet<Dim>* soil = world.find("soil")) {
    const SoilParameters& soils = world.parameters().soil;
    double density = 0;
    for (const SoilPart& s : soils.of)
      if (s.moves) density = std::max(density, s.density);
    if (soils.deformable) media.push_back({density, soil->spacing(), soils.fastest_wave});
  }
  double bound = std::numeric_limits<double>::infinity(), coarsest = 0;
  for (const Medium& m : media) coarsest = std::max(coarsest, m.spacing);
  for (std::size_t b = 0; b < parts.of.size(); ++b) {
    const SolidPart& body = parts.of[b];
    if (body.set != set_name) continue;
    const Shape& shape = *body.shape;
    double thickness = set.spacing();
    if (body.elastic) {
      // Half the body is as thick as its innermost particle is deep.
      for (Index i = 0; i < set.size() && thickness < coarsest; ++i)
        if (part[i] == static_cast<std::int32_t>(b))
          thickness = std::max(
              thickness, set.spacing() - 2 * shape.signed_distance(to_space<Dim>(reference[i])));
    } else {
      const Vec3 extent = shape.box().hi - shape.box().lo;
      thickness =
          std::max(thickness, Dim == 2 ? std::min(extent.x(), extent.z()) : extent.minCoeff());
    }
    for (const Medium& m : media) {
      const double moved = body.elastic ? std::min(thickness, m.spacing) : thickness;
      const double lightness = m.density * m.spacing / (body.density * moved);
      bound = std::min(bound, 0.8 * m.spacing / (m.sound * std::sqrt(lightness)));
      if (body.elastic && lightness > 2)
        bound = std::min(bound, 1.5 * solid_courant(world.parameters().numerics) *
                                    set.smoothing_length() / body.wave_speed);
    }
  }
  return bound;
}

}  // namespace sphgeo
