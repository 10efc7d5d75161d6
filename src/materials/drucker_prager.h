#pragma once
// The stress point of the soil: elastic, perfectly plastic after Drucker and Prager with
// non-associated flow (paper 2.2, Algorithm 1). Dimension-free: plane strain keeps its out-of-plane
// stress. Plain arithmetic without branches on a number type T: double, or lanes of particles.

#include <cmath>

#include "sph/lanes.h"

namespace sphgeo {

/// Constants of one soil (Eqs. 12 to 15), Pa; a soil without plasticity has an infinite strength.
template <class T>
struct DruckerPrager {
  T bulk;      ///< K
  T shear;     ///< G
  T friction;  ///< alpha_phi
  T dilation;  ///< alpha_psi
  T strength;  ///< k_c
  T apex;  ///< largest I1, k_c / alpha_phi; without friction the cone is a cylinder and has none
};

namespace drucker_prager {

/// Stands for no bound: far beyond every stress, and its square is finite.
inline constexpr double unbounded = 1e150;

/// The edge of Mohr and Coulomb's pyramid on which the cone lies. Eq. 14 is that of plane strain;
/// in triaxial compression a soil of 30 degrees then has the strength of 21 degrees.
enum class ConeFit { plane_strain, compression, extension };

/// alpha_phi or alpha_psi of an angle whose tangent is given (Eq. 14 in plane strain).
inline double slope(double tangent, ConeFit cone = ConeFit::plane_strain) {
  if (cone == ConeFit::plane_strain) return tangent / std::sqrt(9 + 12 * tangent * tangent);
  const double sine = tangent / std::sqrt(1 + tangent * tangent);
  return 2 * sine / (std::sqrt(3.0) * (cone == ConeFit::compression ? 3 - sine : 3 + sine));
}
/// k_c of a cohesion [Pa] (Eq. 14 in plane strain).
inline double strength(double cohesion, double tangent, ConeFit cone = ConeFit::plane_strain) {
  if (cone == ConeFit::plane_strain) return 3 * cohesion / std::sqrt(9 + 12 * tangent * tangent);
  const double cosine = 1 / std::sqrt(1 + tangent * tangent), sine = tangent * cosine;
  return 6 * cohesion * cosine /
         (std::sqrt(3.0) * (cone == ConeFit::compression ? 3 - sine : 3 + sine));
}

}  // namespace drucker_prager

/// The same soil with another cohesion, as strength k_c.
template <class T>
DruckerPrager<T> with_strength(DruckerPrager<T> soil, const T& strength) {
  soil.strength = strength;
  // Without friction the quotient is replaced before it is used.
  soil.apex = select(soil.friction > T(0), strength / max(T(1e-30), soil.friction),
                     T(drucker_prager::unbounded));
  return soil;
}

/// Results of one step of the stress point besides the stress.
template <class T>
struct PlasticStep {
  T strain;  ///< equivalent plastic strain, sqrt(2/3 de:de) of its deviator
  T work;    ///< plastic work per volume, J/m3
};

/// Invariants of a stress: I1, the deviator and J2 (below Eq. 13).
template <class T>
struct StressInvariants {
  T first;        ///< I1
  T deviator[6];  ///< xx, yy, zz, xy, yz, xz
  T second;       ///< J2

  explicit StressInvariants(const T (&s)[6]) {
    first = s[0] + s[1] + s[2];
    const T mean = first * T(1.0 / 3.0);
    for (int k = 0; k < 3; ++k) deviator[k] = s[k] - mean;
    for (int k = 3; k < 6; ++k) deviator[k] = s[k];
    second = contract(deviator, deviator) * T(0.5);
  }
  /// a : b of two symmetric tensors.
  static T contract(const T (&a)[6], const T (&b)[6]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] +
           T(2) * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
  }
};

/// Turns a stress by the spin of the velocity gradient over a step: the terms omega.sigma -
/// sigma.omega of Eq. 15. They are integrated by the rotation of Cayley, R = (I - W/2)^-1 (I + W/2)
/// with W = omega dt, instead of Eq. 18: with an Euler step the invariants would grow by (omega
/// dt)^2 in every step.
template <class T>
void rotate_stress(T (&s)[6], const T (&gradient)[3][3], const T& dt) {
  const T half = T(0.25) * dt;  // half the angle: omega is half of the skew part
  const T x = half * (gradient[2][1] - gradient[1][2]);
  const T y = half * (gradient[0][2] - gradient[2][0]);
  const T z = half * (gradient[1][0] - gradient[0][1]);
  const T two = T(2) / (T(1) + x * x + y * y + z * z);
  const T r[3][3] = {{T(1) - two * (y * y + z * z), two * (x * y - z), two * (x * z + y)},
                     {two * (x * y + z), T(1) - two * (x * x + z * z), two * (y * z - x)},
                     {two * (x * z - y), two * (y * z + x), T(1) - two * (x * x + y * y)}};
  const T full[3][3] = {{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}};
  T turned[3][3];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      turned[a][b] = r[a][0] * full[0][b] + r[a][1] * full[1][b] + r[a][2] * full[2][b];
  const auto entry = [&](int a, int b) {
    return turned[a][0] * r[b][0] + turned[a][1] * r[b][1] + turned[a][2] * r[b][2];
  };
  s[0] = entry(0, 0);
  s[1] = entry(1, 1);
  s[2] = entry(2, 2);
  s[3] = entry(0, 1);
  s[4] = entry(1, 2);
  s[5] = entry(0, 2);
}

/// The rate of strain, the symmetric part of the velocity gradient (Eq. 16).
template <class T>
void symmetric_part(const T (&gradient)[3][3], T (&rate)[6]) {
  for (int k = 0; k < 3; ++k) rate[k] = gradient[k][k];
  rate[3] = T(0.5) * (gradient[0][1] + gradient[1][0]);
  rate[4] = T(0.5) * (gradient[1][2] + gradient[2][1]);
  rate[5] = T(0.5) * (gradient[0][2] + gradient[2][0]);
}

/// One step of Algorithm 1: the stress [Pa] at the end of a step of dt [s] with the velocity
/// gradient dv_a/dx_b [1/s]. The stress ends in the yield surface or on it.
///
/// In the paper the direction of the flow and lambda (Eq. 17) are those of the stress at the start
/// of the step. That is stable only while the strain of a step stays below the strain at yield, a
/// few 1e-4 for sand. In a fast shear layer it is a hundred times larger: the plastic correction is
/// then not aligned with the strain increment, the deviator alternates from step to step, and the
/// layer bears 0.40 of its normal stress instead of 0.48. Here both are taken at the end of the
/// step, which Eqs. 12 to 15 allow in closed form; for small steps both agree to first order.
template <class T>
PlasticStep<T> update_stress(T (&stress)[6], const T (&gradient)[3][3], const T& dt,
                             const DruckerPrager<T>& m) {
  using Invariants = StressInvariants<T>;
  rotate_stress(stress, gradient, dt);
  T strain[6];
  symmetric_part(gradient, strain);
  const T trace = strain[0] + strain[1] + strain[2];
  T trial[6];
  for (int k = 0; k < 6; ++k)
    trial[k] = stress[k] +
               T(2) * m.shear * dt * (k < 3 ? strain[k] - trace * T(1.0 / 3.0) : strain[k]) +
               (k < 3 ? m.bulk * trace * dt : T(0));
  const Invariants elastic(trial);
  const T length = sqrt(elastic.second);
  const T flow = max(T(0), length + m.friction * elastic.first - m.strength) /
                 (m.shear + T(9) * m.bulk * m.friction * m.dilation);
  const T first = elastic.first - T(9) * m.bulk * m.dilation * flow;

  // Eq. 19, then Eq. 20 also after it: Algorithm 1 does not change the deviator of a stress moved
  // to the apex, which is then outside of the yield surface.
  const T bounded = min(m.apex, first);
  const T radius = max(T(0), m.strength - m.friction * bounded);
  const T scale = select(length > radius, radius / max(T(1e-140), length), T(1));

  T taken[6], kept[6];
  for (int k = 0; k < 6; ++k) {
    kept[k] = scale * elastic.deviator[k];
    taken[k] = (elastic.deviator[k] - kept[k]) / (T(2) * m.shear);
    stress[k] = k < 3 ? kept[k] + bounded * T(1.0 / 3.0) : kept[k];
  }
  return {
      sqrt(T(2.0 / 3.0) * Invariants::contract(taken, taken)),
      Invariants::contract(kept, taken) + bounded * (elastic.first - bounded) / (T(9) * m.bulk)};
}

}  // namespace sphgeo
