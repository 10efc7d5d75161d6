#pragma once
// Sums over a whole set that probes and the ledger share.

#include <cmath>

#include "core/parallel.h"
#include "materials/drucker_prager.h"
#include "probes/scene_view.h"

namespace sphgeo {

/// Energies of a set, J (J/m in 2D).
struct Energies {
  double kinetic = 0;
  double potential = 0;  ///< in the deck's gravity, about the origin
  double internal = 0;   ///< of compression, zero at rho0
  double total() const { return kinetic + potential + internal; }
  Energies operator+(const Energies& e) const {
    return {kinetic + e.kinetic, potential + e.potential, internal + e.internal};
  }
};

inline Energies water_energies(const SceneView& scene) {
  Energies e;
  if (!scene.has_set("water")) return e;
  const Index n = scene.size("water");
  const auto m = scene.scalar("water", fields::mass);
  const auto rho = scene.scalar("water", fields::density);
  const auto x = scene.vector("water", fields::position);
  const auto v = scene.vector("water", fields::velocity);
  const double c = scene.parameters().water.sound_speed, rho0 = scene.parameters().water.density;
  const Vec3 g = scene.parameters().gravity;
  e.kinetic = ordered_sum(n, [&](Index i) { return 0.5 * m(i) * v(i).squaredNorm(); });
  e.potential = ordered_sum(n, [&](Index i) { return -m(i) * g.dot(x(i)); });
  // The integral of p / rho^2 d rho from rho0, with p of Eq. 26.
  e.internal = ordered_sum(
      n, [&](Index i) { return m(i) * c * c * (std::log(rho(i) / rho0) + rho0 / rho(i) - 1); });
  return e;
}

/// Energies of a soil set: `internal` is the elastic energy, zero at no stress.
inline Energies soil_energies(const SceneView& scene) {
  Energies e;
  if (!scene.has_set("soil")) return e;
  const Index n = scene.size("soil");
  const auto m = scene.scalar("soil", fields::mass), volume = scene.scalar("soil", fields::volume);
  const auto x = scene.vector("soil", fields::position), v = scene.vector("soil", fields::velocity);
  const auto stress = scene.tensor("soil", fields::stress);
  const auto part = scene.tag("soil", fields::part);
  const Vec3 g = scene.parameters().gravity;
  e.kinetic = ordered_sum(n, [&](Index i) { return 0.5 * m(i) * v(i).squaredNorm(); });
  e.potential = ordered_sum(n, [&](Index i) { return -m(i) * g.dot(x(i)); });
  // 1 / 2G, 1 / 18K by body; what has no stiffness does not deform and stores nothing.
  std::vector<std::pair<double, double>> compliance;
  for (const SoilPart& p : scene.parameters().soil.of)
    if (p.constants.bulk > 0)
      compliance.emplace_back(1 / (2 * p.constants.shear), 1 / (18 * p.constants.bulk));
    else compliance.emplace_back(0, 0);
  e.internal = ordered_sum(n, [&](Index i) {
    const Sym3 s = stress(i);
    const double numbers[6] = {s[0], s[1], s[2], s[3], s[4], s[5]};
    const StressInvariants<double> invariants(numbers);
    const auto& [shear, bulk] = compliance[static_cast<std::size_t>(part(i))];
    return volume(i) * (invariants.second * shear + invariants.first * invariants.first * bulk);
  });
  return e;
}

/// Energy that plastic flow of the soil has dissipated so far, J (J/m in 2D).
inline double dissipated_energy(const SceneView& scene) {
  if (!scene.has_set("soil")) return 0;
  const auto work = scene.scalar("soil", fields::plastic_work);
  return ordered_sum(scene.size("soil"), [&](Index i) { return work(i); });
}

}  // namespace sphgeo
