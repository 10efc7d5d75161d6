#include "scene/particle_count.h"

#include "boundaries/boundary.h"
#include "boundaries/exchange.h"
#include "geometry/fill.h"
#include "materials/solid.h"
#include "scene/build.h"
#include "scene/interface.h"
#include "scene/pore_water.h"

namespace sphgeo {
namespace {

void add(ParticleCounts& counts, const std::string& set, double n) {
  for (auto& [name, sum] : counts)
    if (name == set) {
      sum += n;
      return;
    }
  counts.emplace_back(set, n);
}

}  // namespace

ParticleCounts expected_particles(const Model& model) {
  ParticleCounts counts;
  const std::vector<double> shares = expected_shares(model);
  for (std::size_t k = 0; k < model.bodies.size(); ++k) {
    const Body& b = model.bodies[k];
    if (const MaterialSpec* m = model.material(b.material); m && b.shape)
      add(counts, m->phase() == "solid" ? solid_set_of(model, k) : m->phase(),
          shares[k] *
              estimate_fill(*b.shape, b.spacing.value_or(model.resolution), model.dimension, {}));
  }
  if (has_interface(model))
    for (const Body& b : model.bodies)
      if (solid_of(model, b) && b.shape)
        add(counts, "interface",
            estimate_layers(*b.shape, b.spacing.value_or(model.resolution), model.dimension,
                            interface_depth(model), LayerSide::inside));
  const Placement placement{model.resolution, support_radius(model), model.dimension};
  for (const auto& b : model.boundaries)
    if (const auto* wall = dynamic_cast<const WallBoundary*>(b.get()))
      add(counts, "walls", wall->expected_points(placement));
  return counts;
}

double entering_particles(const Model& model) {
  double sum = 0;
  for (const auto& b : model.boundaries)
    if (const auto* border = dynamic_cast<const ExchangeBoundary*>(b.get()))
      sum += border->expected_particles(model.resolution, model.dimension, 0, model.end_time)
                 .value_or(0);
  return sum;
}

double count_of(const ParticleCounts& counts, const std::string& set) {
  for (const auto& [name, n] : counts)
    if (name == set) return n;
  return 0;
}

double total_of(const ParticleCounts& counts) {
  double sum = 0;
  for (const auto& [name, n] : counts) sum += n;
  return sum;
}

Model at_resolution(const Model& model, double spacing) {
  Model other = model;
  // Solids with their own spacing keep its ratio to that of the others.
  for (Body& b : other.bodies)
    if (b.spacing) *b.spacing *= spacing / model.resolution;
  other.resolution = spacing;
  return other;
}

}  // namespace sphgeo
