#pragma once
// Hyperelastic laws of one material point (paper 2.5), on 3x3 tensors.

#include <Eigen/LU>
#include <cmath>

#include "core/types.h"

namespace sphgeo {

/// Constants of a law.
struct Hyperelastic {
  double shear;             ///< mu = G, Pa
  double lame;              ///< lambda, Pa
  bool neo_hookean = true;  ///< Eqs. 39, 40; else St. Venant-Kirchhoff, Eq. 38
};

/// Green-Lagrange strain of F = I + g (Eq. 37), without the cancellation of F^T F - I.
inline Mat3 green_strain(const Mat3& g) { return 0.5 * (g + g.transpose() + g.transpose() * g); }

/// J - 1 of F = I + g, without cancellation.
inline double volume_change(const Mat3& g) {
  const double trace = g.trace();
  return trace + 0.5 * (trace * trace - (g * g).trace()) + g.determinant();
}

/// Second Piola-Kirchhoff stress at F = I + g, Pa; not finite where J <= 0.
inline Mat3 second_piola(const Mat3& g, const Hyperelastic& m) {
  const Mat3 strain = green_strain(g);
  if (!m.neo_hookean) return m.lame * strain.trace() * Mat3::Identity() + 2 * m.shear * strain;
  // I - C^-1 = C^-1 (C - I) = C^-1 2 E.
  const Mat3 inverse = (Mat3::Identity() + 2 * strain).inverse();
  return inverse *
         (2 * m.shear * strain + m.lame * std::log1p(volume_change(g)) * Mat3::Identity());
}

/// Strain energy per volume at rest, J/m3.
inline double strain_energy_density(const Mat3& g, const Hyperelastic& m) {
  const Mat3 strain = green_strain(g);
  const double trace = strain.trace();
  if (!m.neo_hookean) return 0.5 * m.lame * trace * trace + m.shear * strain.squaredNorm();
  const double log_j = std::log1p(volume_change(g));
  return m.shear * (trace - log_j) + 0.5 * m.lame * log_j * log_j;
}

}  // namespace sphgeo
