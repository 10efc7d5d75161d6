#pragma once
// Sums over a whole set that probes and the ledger share.

#include <cmath>

#include "core/parallel.h"
#include "probes/scene_view.h"

namespace sphgeo {

/// Energies of a water set, J (J/m in 2D).
struct Energies {
  double kinetic = 0;
  double potential = 0;   ///< in the deck's gravity, about the origin
  double internal = 0;    ///< of compression, zero at rho0
  double total() const { return kinetic + potential + internal; }
};

inline Energies water_energies(const SceneView& scene) {
  Energies e;
  if (!scene.has_set("water")) return e;
  const Index n = scene.size("water");
  const auto m = scene.scalar("water", fields::mass);
  const auto rho = scene.scalar("water", fields::density);
  const auto x = scene.vector("water", fields::position);
  const auto v = scene.vector("water", fields::velocity);
  const double c = scene.constant("water", "sound_speed"), rho0 = scene.constant("water", "density");
  const Vec3 g = scene.model().gravity;
  e.kinetic = ordered_sum(n, [&](Index i) { return 0.5 * m(i) * v(i).squaredNorm(); });
  e.potential = ordered_sum(n, [&](Index i) { return -m(i) * g.dot(x(i)); });
  // The integral of p / rho^2 d rho from rho0, with p of Eq. 26.
  e.internal = ordered_sum(n, [&](Index i) {
    return m(i) * c * c * (std::log(rho(i) / rho0) + rho0 / rho(i) - 1);
  });
  return e;
}

}  // namespace sphgeo
