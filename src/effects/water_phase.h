#pragma once
// What the effects of the water phase share: constants, scales, the Riemann flux.

#include "effects/effect.h"
#include "effects/water_packing.h"
#include "sph/gather.h"
#include "sph/kernel.h"
#include "sph/parameters.h"
#include "sph/world.h"

namespace sphgeo {

/// Whether the volume of the water follows the porosity of soil (Eq. 27).
template <int Dim>
bool volume_follows_porosity(const World<Dim>& world) {
  return world.parameters().water.follows_porosity;
}

/// n^w of the water (Eq. 27); null where its volume does not follow it.
template <int Dim>
const Field<double>* volume_share(const World<Dim>& world) {
  return volume_follows_porosity(world) ? &world.set("water").scalar(fields::water_fraction)
                                        : nullptr;
}

/// Names the need of volume_share(), where there is one.
template <int Dim>
void need_volume_share(const World<Dim>& world, Needs& needs) {
  if (volume_follows_porosity(world))
    needs.fields.push_back({"water", &fields::water_fraction, Access::read});
}

/// What the pair sums of gradients between water particles are multiplied by, as one factor for
/// each side of a pair: 1 in clear water. In soil the particles are spread wider than the kernel
/// was made for, and their sums give the gradient of a linear field several percent too small. One
/// factor a side leaves action and reaction equal. Walls have that of the water particle they meet,
/// so that a constant pressure does not push a particle that lies evenly between water and wall.
/// Null where there is no water in soil.
template <int Dim>
const Field<double>* gradient_scale(const World<Dim>& world) {
  return volume_follows_porosity(world) ? &world.set("water").scalar(fields::gradient_scale)
                                        : nullptr;
}

/// Value of the field `surface` where less than half the neighborhood of a particle is filled.
inline constexpr std::int32_t spray = 2;

/// Low-dissipation Riemann flux of the water, between equal materials (Eqs. 61-63).
struct RiemannFlux {
  double impedance;      ///< rho0 c0
  double inverse_sound;  ///< 1 / c0
  double limiter;        ///< xi

  explicit RiemannFlux(const WaterParameters& w)
      : impedance(w.density * w.sound_speed),
        inverse_sound(1.0 / w.sound_speed),
        limiter(w.limiter) {}

  /// Twice the dissipative part of P*: beta rho0 c0 (U_L - U_R), zero when the pair separates.
  /// With equal densities and sound speeds the limiter of Eq. 63 is min(xi max(U_L - U_R, 0) / c0,
  /// 1).
  template <class T>
  T dissipation(const T& approach) const {
    const T closing = max(T(0), approach);
    const T beta = min(T(limiter * inverse_sound) * closing, T(1));
    return beta * T(impedance) * closing;
  }
};

/// The sums of a gather as a vector of the scene.
template <int Dim>
Vec<Dim> to_vec(const LaneVec<Dim, double>& a) {
  Vec<Dim> v;
  for (int k = 0; k < Dim; ++k) v[k] = a[k];
  return v;
}

}  // namespace sphgeo
