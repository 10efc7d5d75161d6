#pragma once
// Soil against wall particles: one pair function for both directions (Eqs. 69, 70, 95).

#include "effects/soil_phase.h"
#include "effects/wall_pair.h"

namespace sphgeo {

/// One-sided Riemann problem between a soil particle and a wall particle.
///
/// The wall carries the stress of the soil particle (Eq. 69), plus the imaginary pressure of Eq. 95 by
/// which the wall holds the soil up: without it the soil at a floor would bear half a spacing too
/// little, and soil beside a smooth wall would lose half of the vertical gradient of its stress and
/// sink. Signs and the part along the wall are those of the water (see WallPair). A wall that lets the
/// soil slide bears no shear stress.
template <int Dim>
struct SoilWallPair {
  Kernel<Dim> kernel;
  double limiter;  ///< xi^s
  double near;     ///< distance below which a particle of the wall is too close, m
  double per_spacing;  ///< 1 / dp

  SoilWallPair(const World<Dim>& world, const ParticleSet<Dim>& soil)
      : kernel(soil_kernel(soil)), limiter(soil_limiter(world)), near(0.75 * soil.spacing()), per_spacing(1 / soil.spacing()) {}

  /// Velocity of the wall's particle less that of the soil's, of the mirrored velocity of Eq. 69.
  template <class T, int N>
  static LaneVec<Dim, T> mirrored(const Record<Dim, T, N>& soil, const Record<Dim, T, 2>& wall) {
    const LaneVec<Dim, T> n = wall.vec(wall_slot::normal);
    const LaneVec<Dim, T> dv = wall.vec(wall_slot::velocity) - soil.vec(soil_slot::velocity);
    const T sticking = wall[wall_slot::no_slip];
    return T(2) * (sticking * dv + ((T(1) - sticking) * dot(dv, n)) * n);
  }

  /// Force of the wall on the soil per unit volume of the soil; r = r_soil - r_wall.
  template <class T>
  LaneVec<Dim, T> force(const Record<Dim, T, 3>& soil, const Record<Dim, T, 2>& wall,
                        const LaneVec<Dim, T>& r, const T& r2) const {
    using namespace soil_slot;
    const LaneVec<Dim, T> n = wall.vec(wall_slot::normal);
    const T gradient = kernel.dw_over_r(r2) * wall[wall_slot::volume];
    const T r_n = dot(r, n);
    const LaneVec<Dim, T> along = r - r_n * n;
    LaneVec<Dim, T> pull_of_soil;
    for (int k = 0; k < Dim; ++k) pull_of_soil[k] = soil[pull + k];
    const T rise = wall[wall_slot::push] * max(T(0), r_n);
    // A layer of sand that has spread to less than the size of a particle bears no stress that could hold it
    // up. A particle nearer to the surface of the wall than a quarter of a spacing meets the bulk modulus.
    const T bulk = soil[impedance] * soil[impedance] / max(T(1e-30), soil[density]);
    const T contact = bulk * (T(per_spacing) * max(T(0), T(near) - r_n));
    const T dummy = soil[present_density] * (rise - dot(pull_of_soil, along)) + contact;
    const LaneVec<Dim, T> on_wall = times(soil.slot + stress, n);
    const LaneVec<Dim, T> shear = on_wall - dot(on_wall, n) * n;
    LaneVec<Dim, T> f = T(2) * times(soil.slot + stress, r) - dummy * r;
    f -= (T(2) * (T(1) - wall[wall_slot::no_slip])) * (r_n * shear + dot(shear, along) * n);
    // Dissipation along the normal (Eqs. 54, 69): U_L - U_R = -2 (v - v_wall) . n.
    const T closing = max(T(0), T(2) * dot(wall.vec(wall_slot::velocity) - soil.vec(velocity), n));
    T beta = min(T(limiter) * soil[density] / max(T(1e-30), soil[impedance]) * closing, T(1));
    static const int wm = std::getenv("WALLM") ? std::atoi(std::getenv("WALLM")) : 0;
    if (wm == 1) beta = T(1);
    if (wm == 2) beta = select(r_n < T(near), T(1), beta);
    return gradient * f - (beta * soil[impedance] * closing * gradient * length(r2)) * n;
  }
};

/// Writes g - dv/dt and the present density of soil particles to their third records.
template <int Dim>
class SoilPull {
 public:
  SoilPull(const World<Dim>& world, const ParticleSet<Dim>& soil)
      : world_(world), x_(soil.vector(fields::position)), a_(soil.vector(fields::acceleration)),
        m_(soil.scalar(fields::mass)), volume_(soil.scalar(fields::volume)) {}

  template <class T>
  void operator()(Records<Dim, T>& third, Index i) const {
    T* slot = third[i] - 2 * record_size;  // slots of the third record count on from the second
    const Vec<Dim> pull = world_.pull(x_[i]) - a_[i];
    for (int k = 0; k < Dim; ++k) slot[soil_slot::pull + k] = static_cast<T>(pull[k]);
    slot[soil_slot::present_density] = static_cast<T>(m_[i] / volume_[i]);
  }

 private:
  const World<Dim>& world_;
  const Field<Vec<Dim>>& x_;
  const Field<Vec<Dim>>& a_;
  const Field<double>& m_;
  const Field<double>& volume_;
};

}  // namespace sphgeo
