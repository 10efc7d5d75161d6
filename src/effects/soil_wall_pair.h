#pragma once
// Soil against wall particles: one pair function for both directions (Eqs. 69, 70, 95).

#include <algorithm>

#include "effects/soil_phase.h"
#include "effects/wall_pair.h"

namespace sphgeo {

/// One-sided Riemann problem between a soil particle and a wall particle.
///
/// The wall carries the stress of the soil particle (Eq. 69), with the correction B of its
/// gradient, along the normal; a wall that lets the soil slide bears no shear stress. What of the
/// gradient runs along the wall comes from the soil alone, and B makes up for the half that the
/// wall does not give. So this force, too, is the adjoint of what the wall adds to the velocity
/// gradient (see StressPair). To it comes the imaginary pressure of Eq. 95 by which the wall holds
/// the soil up (the sign as for water, see WallPair): without it the soil at a floor would bear
/// half a spacing too little.
///
/// Particles of smooth walls in a concave corner, behind two walls at once, carry no stress. What a
/// wall adds along its normal balances the soil on the other side of the particle, and along the
/// wall nothing is added on either side; a corner has nothing opposite it but the other wall, which
/// adds nothing in that direction, so whatever it added would be in excess (15 % of the stress at
/// the foot of a column that is five particles wide, 33 % in 3D). The correction B makes up for
/// what is missing. They only hold back what would pass between the two walls, nearer than the half
/// diagonal at which a lattice begins. A rough wall stops motion in every direction also there;
/// without it sand is squeezed into the corner, and energy grows.
template <int Dim>
struct SoilWallPair {
  using Soil = packed::SoilState<Dim>;
  using Parameters = packed::SoilContact<Dim>;
  using Wall = packed::Wall<Dim>;
  using Surface = packed::WallSurface<Dim>;
  Kernel<Dim> kernel;
  double limiter;      ///< xi^s
  double near;         ///< distance below which a particle of a wall is too close, m
  double per_spacing;  ///< 1 / dp
  double per_step;     ///< 1 / dt

  SoilWallPair(const World<Dim>& world, const ParticleSet<Dim>& soil)
      : kernel(soil_kernel(soil)),
        limiter(world.parameters().soil.limiter),
        near(0.85 * soil.spacing()),
        per_spacing(1 / soil.spacing()),
        per_step(1 / std::max(world.clock.dt_acoustic, 1e-12)) {}

  /// Velocity of the wall's particle less that of the soil's, of the mirrored velocity of Eq. 69.
  template <class T, class... R>
  static LaneVec<Dim, T> mirrored(const Record<T, R...>& soil, const WallRecord<Dim, T>& wall) {
    const LaneVec<Dim, T> n = wall.vec(Surface::normal);
    const LaneVec<Dim, T> dv = wall.vec(Wall::velocity) - soil.vec(Soil::velocity);
    const T sticking = wall[Wall::no_slip];
    return T(2) * (sticking * dv + ((T(1) - sticking) * dot(dv, n)) * n);
  }

  /// W'(r) V / r of a wall particle that carries stress. Behind the surface of this particle, as
  /// beside a rim, it has nothing to say.
  template <class T>
  T slope(const WallRecord<Dim, T>& wall, const T& r_n, const T& r2) const {
    return select(r_n > T(0), kernel.dw_over_r(r2) * wall[Wall::volume] * wall[Surface::face],
                  T(0));
  }

  /// Force of the wall on the soil per unit volume of the soil; r = r_soil - r_wall.
  template <class T>
  LaneVec<Dim, T> force(const SoilRecord<Dim, T>& soil, const WallRecord<Dim, T>& wall,
                        const LaneVec<Dim, T>& r, const T& r2) const {
    const LaneVec<Dim, T> n = wall.vec(Surface::normal);
    const T r_n = dot(r, n);
    const T face = wall[Surface::face];
    const T gradient = select(r_n > T(0), kernel.dw_over_r(r2) * wall[Wall::volume], T(0));
    const T sticking = wall[Wall::no_slip];
    // A layer of sand that has spread to less than the size of a particle bears no stress that
    // could hold it up: a particle that comes too near to one of the wall meets the bulk modulus,
    // along the line between them, so that it is as right beside a rim or an edge as over a plane.
    // In a square of four it comes down to the level of the surface.
    const T bulk = soil[Parameters::impedance] * soil[Parameters::impedance] /
                   max(T(1e-30), soil[Parameters::density]);
    // Solids may be finer or coarser than the soil: the mean of both.
    const T apart = T(near) + T(0.5) * wall[Surface::deformable] * (wall[Surface::near] - T(near));
    const T contact =
        bulk * (T(per_spacing) * max(T(0), apart * (T(0.7) + T(0.3) * face) - length(r2)));
    const T height = face * max(T(0), r_n);
    const T rise = soil[packed::SoilWeight<Dim>::borne] * soil[Parameters::density] *
                   max(T(0), wall[Surface::push]) * height;
    T tensor[Dim * Dim];
    unpack_stress<Dim>(soil, tensor);
    const LaneVec<Dim, T> on_wall = times(tensor, (face * r_n) * n);
    LaneVec<Dim, T> f = T(2) * (sticking * on_wall + ((T(1) - sticking) * dot(on_wall, n)) * n) -
                        (rise * r_n) * n - contact * r;
    // Coulomb friction of what the wall bears beside the stress: no more than what stops the
    // particle within the step.
    const LaneVec<Dim, T> dv = soil.vec(Soil::velocity) - wall.vec(Wall::velocity);
    const LaneVec<Dim, T> slip = dv - dot(dv, n) * n;
    const T slip2 = dot(slip, slip);
    const T grip = min(soil[Parameters::friction] * (rise + contact) * inverse_length(slip2),
                       soil[Parameters::density] * T(per_step) * max(T(0), r_n));
    f += (sticking * grip * r_n) * slip;
    // Dissipation along the normal (Eqs. 54, 69): U_L - U_R = -2 (v - v_wall) . n.
    const T closing = max(T(0), T(2) * dot(wall.vec(Wall::velocity) - soil.vec(Soil::velocity), n));
    const T beta = min(T(limiter) * soil[Parameters::density] /
                           max(T(1e-30), soil[Parameters::impedance]) * closing,
                       T(1));
    return gradient * f -
           (beta * soil[Parameters::impedance] * closing * gradient * length(r2)) * n;
  }
};

/// The reaction: the same pair function, seen from the wall.
template <int Dim>
struct SoilForceOnWall {
  SoilWallPair<Dim> wall;

  template <class T>
  struct Sums {
    LaneVec<Dim, T> force{};
  };
  template <class T>
  void operator()(Sums<T>& sum, const WallRecord<Dim, T>& i, const SoilRecord<Dim, T>& j,
                  const LaneVec<Dim, T>& r, const T& r2) const {
    sum.force -= j[packed::SoilState<Dim>::volume] * wall.force(j, i, T(-1) * r, r2);
  }
};

}  // namespace sphgeo
