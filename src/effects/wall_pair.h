#pragma once
// Water against wall particles: one pair function for both directions (Eqs. 73, 74, 76, 77).

#include <cmath>

#include "effects/lattice_sums.h"
#include "effects/wall_packing.h"
#include "effects/water_phase.h"

namespace sphgeo {

/// What a pass sees of a wall particle.
template <int Dim, class T>
using WallRecord = Record<T, packed::Wall<Dim>, packed::WallSurface<Dim>>;

/// Both records of a set of walls.
template <class T, int Dim>
auto wall_records(World<Dim>& world, const std::string& set) {
  return with(read_records<packed::Wall<Dim>, T>(world, set),
              read_records<packed::WallSurface<Dim>, T>(world, set));
}

/// Names them, and the positions.
template <int Dim>
void need_wall_records(Needs& needs, const std::string& set) {
  needs.record<Position<Dim>>(set, Access::read);
  needs.record<packed::Wall<Dim>>(set, Access::read);
  needs.record<packed::WallSurface<Dim>>(set, Access::read);
}

/// One-sided Riemann problem between a water particle and a wall particle.
///
/// Dummy pressure. Eq. 73 in the paper is p + rho max[0, (g - a).n (r.n)] with n outward; that is
/// zero under still water, so the sign of the bracket is turned: it rises when the wall pushes on
/// the water. The paper's zero leaves a lid, or the lower side of a body, the pressure of the water
/// below it: half a spacing of hydrostatic pressure too much, in the buoyancy of every body. So
/// there it falls as it does at rest, but no wall draws: neither below zero nor, by moving away,
/// below that at rest. Along the wall the paper keeps the pressure constant, which removes the
/// wall's half of the vertical pressure gradient at a side wall, and still water would sink along
/// it. There the momentum equation of the water itself, grad p = rho (g - dv/dt), carries the
/// pressure along the wall: hydrostatic at rest, constant in free fall. dv/dt is that of the last
/// acoustic step. Both are divided by the kernel's lattice moment (0.995 in 2D for h = 1.8 dp): in
/// still water the pressure gradient is as much steeper than rho g as the sum over the water is
/// weaker, and the wall has to follow it.
///
/// The density dissipation acts on the part of the pressure force beyond gravity, under a lid as
/// over a floor. Anything left at rest would be a source of water: in pores, where drag holds it, a
/// lasting flow away from every surface that faces down.
///
/// Solids. Eq. 95 takes their mean acceleration for the push. For a plate lighter than the water
/// that its kernel reaches, what one step does with it is undone by more than as much in the next,
/// and its particles shake ever harder. What it stands for is the pressure gradient in the water at
/// a surface that moves with it: so here, too, it is that of the water itself, -(g - dv/dt) . n
/// where that presses the water against the solid. A plate may be thinner than half a kernel, and
/// then has less than a wall's worth of particles to hold water back with: water that comes too
/// near to one of them meets the bulk modulus, so that nothing gets through however thin it is.
template <int Dim>
struct WallPair {
  using Wall = packed::Wall<Dim>;
  using Surface = packed::WallSurface<Dim>;
  using Water = packed::WaterState<Dim>;
  using Gradient = packed::PressureGradient<Dim>;
  Kernel<Dim> kernel;
  RiemannFlux riemann;
  double inverse_sound;  ///< 1 / c0
  double two_eta;
  double softening;  ///< 0.01 h^2
  double slope;  ///< 1 / lattice_moment: the pressure gradient that the water's own sum balances
  double bulk;   ///< rho0 c0^2 times the volume of a water particle

  WallPair(const WaterParameters& w, double h, double dp)
      : kernel(h),
        riemann(w),
        inverse_sound(1 / w.sound_speed),
        two_eta(2 * w.viscosity),
        softening(0.01 * h * h),
        slope(1 / lattice_sums(kernel, dp).moment),
        bulk(w.density * w.sound_speed * w.sound_speed * std::pow(dp, Dim)) {}

  /// Pressure rise of the wall by the push of Eq. 73, per rho, for the density dissipation.
  template <class T>
  static T rise(const WallRecord<Dim, T>& wall, const T& r_n) {
    return wall[Surface::push] * max(T(0), r_n);
  }
  /// The same for the force, where the surface of a solid takes the water's own acceleration.
  template <class T, class AtWall>
  static T rise(const AtWall& water, const WallRecord<Dim, T>& wall, const LaneVec<Dim, T>& n,
                const T& r_n) {
    const T own =
        max(min(T(0), wall[Surface::weight]), T(-1) * dot(water.vec(Gradient::over_density), n));
    const T push = wall[Surface::push] + wall[Surface::deformable] * (own - wall[Surface::push]);
    return max(T(-1) * max(T(0), water[Water::pressure]) / water[Gradient::density],
               push * max(T(0), r_n));
  }

  /// Friction of the wall on the water per unit volume of the water.
  template <class T, class AtWall>
  LaneVec<Dim, T> friction(const AtWall& water, const WallRecord<Dim, T>& wall, const T& r2) const {
    const LaneVec<Dim, T> dv = water.vec(Water::velocity) - wall.vec(Wall::velocity);
    const T gradient = kernel.dw_over_r(r2) * wall[Wall::volume];
    return (T(two_eta) * T(2) * wall[Wall::no_slip] * gradient * r2 / (r2 + T(softening))) * dv;
  }

  /// Force of the wall on the water per unit volume of the water; r = r_water - r_wall.
  template <class T, class AtWall>
  LaneVec<Dim, T> force(const AtWall& water, const WallRecord<Dim, T>& wall,
                        const LaneVec<Dim, T>& r, const T& r2) const {
    LaneVec<Dim, T> f = pressure(water, wall, r, r2);
    f += friction(water, wall, r2);
    return f;
  }

  /// The part of it that is pressure.
  template <class T, class AtWall>
  LaneVec<Dim, T> pressure(const AtWall& water, const WallRecord<Dim, T>& wall,
                           const LaneVec<Dim, T>& r, const T& r2) const {
    const LaneVec<Dim, T> n = wall.vec(Surface::normal);
    const LaneVec<Dim, T> dv = water.vec(Water::velocity) - wall.vec(Wall::velocity);
    const T gradient = kernel.dw_over_r(r2) * wall[Wall::volume];
    const T r_n = dot(r, n);
    const LaneVec<Dim, T> along = r - r_n * n;
    const T dummy =
        T(slope) * (rise(water, wall, n, r_n) - dot(water.vec(Gradient::over_density), along));
    const T pressures = T(2) * water[Water::pressure] + water[Gradient::density] * dummy;
    // v_i - v_wall^d = 2 (v_i - v_wall) along n, with no slip or without.
    const T dissipation = riemann.dissipation(T(-2) * dot(dv, n));
    // Per volume of the solid's particle: a fine one holds as much as a coarse one.
    const T close = max(T(0), wall[Surface::near] - length(r2));
    const T hold = T(bulk) * close / max(T(1e-30), wall[Surface::near] * wall[Wall::volume]);
    LaneVec<Dim, T> f = (T(-1) * (pressures + hold) * gradient) * r;
    f -= (dissipation * gradient * length(r2)) * n;
    return f;
  }

  /// Divergence of the velocity at the water, that of packed::WaterState or packed::Mixture, with
  /// the Riemann density dissipation (Eq. 58).
  template <class T, class Moving>
  T divergence(const Record<T, Moving>& water, const WallRecord<Dim, T>& wall,
               const LaneVec<Dim, T>& r, const T& r2) const {
    const LaneVec<Dim, T> n = wall.vec(Surface::normal);
    const LaneVec<Dim, T> dv = water.vec(Moving::velocity) - wall.vec(Wall::velocity);
    const T gradient = kernel.dw_over_r(r2) * wall[Wall::volume];
    const T r_n = dot(r, n);
    const T sticking = wall[Wall::no_slip];
    const T dv_r = sticking * dot(dv, r) + (T(1) - sticking) * dot(dv, n) * r_n;
    // p_i - p_wall^d, balanced like that of two water particles: what is left is the push beyond
    // gravity.
    const T excess = rise(wall, r_n) - wall[Surface::weight] * r_n;
    const T dissipation = T(-1) * excess * T(inverse_sound) * length(r2);
    return (T(2) * dv_r + dissipation) * gradient;
  }
};

}  // namespace sphgeo
