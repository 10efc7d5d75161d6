#pragma once
// Access of probes to solids by body, independent of the set that holds it.

#include <functional>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "materials/solid.h"
#include "probes/set_sums.h"

namespace sphgeo {

/// Index of the body of that name, or -1.
inline std::int32_t body_index(const Model& model, const std::string& name) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (model.bodies[b].name == name) return static_cast<std::int32_t>(b);
  return -1;
}

/// The set that holds a solid body; "solids" when the name is empty or no solid (check names the
/// mistake).
inline std::string set_of_body(const Model& model, const std::string& name) {
  const std::int32_t b = body_index(model, name);
  const std::string set = b < 0 ? "" : solid_set_of(model, static_cast<std::size_t>(b));
  return set.empty() ? "solids" : set;
}

/// Reports a body that is not a solid of the deck.
inline void inspect_body(const Model& model, const std::string& name, const char* key,
                         CheckContext& c) {
  const std::int32_t b = body_index(model, name);
  if (b >= 0 && !solid_set_of(model, static_cast<std::size_t>(b)).empty()) return;
  c.error(key, b < 0 ? "there is no body '" + name + "'" : "body '" + name + "' is not a solid",
          "name a body whose material is elastic or rigid");
}

/// Energy that is stored in the contacts of solids, J; of one body's side alone, or of all.
inline double contact_energy(const SceneView& scene, std::int32_t body = -1) {
  if (!scene.has_field("interface", fields::contact_energy)) return 0;
  const auto energy = scene.scalar("interface", fields::contact_energy);
  const auto part = scene.tag("interface", fields::part);
  return ordered_sum(scene.size("interface"),
                     [&](Index i) { return body < 0 || part(i) == body ? energy(i) : 0.0; });
}

/// Energies of the solids of a set: `internal` is the strain energy. `body`: of that one alone, or
/// -1.
inline Energies solid_energies(const SceneView& scene, const std::string& set,
                               std::int32_t body = -1) {
  Energies e;
  if (!scene.has_set(set)) return e;
  const Index n = scene.size(set);
  const auto m = scene.scalar(set, fields::mass);
  const auto x = scene.vector(set, fields::position), v = scene.vector(set, fields::velocity);
  const auto part = scene.tag(set, fields::part);
  const Vec3 g = scene.parameters().gravity;
  const auto share = [&](Index i) { return body < 0 || part(i) == body ? 1.0 : 0.0; };
  e.kinetic = ordered_sum(n, [&](Index i) { return share(i) * 0.5 * m(i) * v(i).squaredNorm(); });
  e.potential = ordered_sum(n, [&](Index i) { return -share(i) * m(i) * g.dot(x(i)); });
  if (scene.has_field(set, fields::strain_energy)) {
    const auto strain = scene.scalar(set, fields::strain_energy);
    e.internal = ordered_sum(n, [&](Index i) { return share(i) * strain(i); });
  }
  return e;
}

}  // namespace sphgeo
