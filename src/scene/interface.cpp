#include "scene/interface.h"

#include <algorithm>
#include <cmath>

#include "boundaries/boundary.h"
#include "geometry/normal.h"
#include "materials/solid.h"

namespace sphgeo {
bool has_interface(const Model& model) {
  const auto solids = std::count_if(model.bodies.begin(), model.bodies.end(),
                                    [&](const Body& b) { return solid_of(model, b) != nullptr; });
  const bool folds = std::any_of(model.bodies.begin(), model.bodies.end(),
                                 [](const Body& b) { return b.self_contact; });
  return solids > 0 &&
         (solids < std::ssize(model.bodies) || solids > 1 || folds || !model.boundaries.empty());
}

double interface_depth(const Model& model) {
  double depth = support_radius(model);
  for (const double spacing : solid_spacings(model))
    depth = std::max(depth, 2 * model.numerics.h_factor_solid.value_or(1.15) * spacing);
  return depth;
}

namespace {

/// The solids of the boundaries as they are at t = 0.
std::vector<std::shared_ptr<const Shape>> wall_solids(const Model& model, int dimension) {
  std::vector<std::shared_ptr<const Shape>> solids;
  const Placement placement{model.resolution, support_radius(model), dimension};
  for (const auto& b : model.boundaries)
    if (const auto* wall = dynamic_cast<const WallBoundary*>(b.get()))
      if (auto solid = wall->solid(placement)) solids.push_back(std::move(solid));
  return solids;
}

template <int Dim>
void follow(ParticleSet<Dim>& interface, const ParticleSet<Dim>& solids, std::int32_t number,
            const Model& model, double depth) {
  const auto walls = wall_solids(model, Dim);
  std::vector<Index> near;
  for (Index i = 0; i < solids.size(); ++i) {
    const Body& body = model.bodies[static_cast<std::size_t>(solids.tag(fields::part)[i])];
    const Vec3 at = to_space<Dim>(solids.vector(fields::reference_position)[i]);
    if (body.shape->signed_distance(at) <= -depth) continue;
    // A part clamped within a wall, such as the foot of a plate: the wall particles fill that
    // region, and it would be counted twice.
    const bool walled = solids.tag(fields::clamp)[i] >= 0 &&
                        std::any_of(walls.begin(), walls.end(), [&](const auto& wall) {
                          return wall->signed_distance(at) < 0;
                        });
    if (!walled) near.push_back(i);
  }
  const Index first = interface.size();
  interface.resize(first + static_cast<Index>(near.size()));
  for (std::size_t k = 0; k < near.size(); ++k) {
    const Index i = near[k], to = first + static_cast<Index>(k);
    const std::int32_t part = solids.tag(fields::part)[i];
    const Body& body = model.bodies[static_cast<std::size_t>(part)];
    interface.ids()[to] = static_cast<Id>(to);
    interface.tag(fields::part)[to] = part;
    interface.tag(fields::source)[to] = static_cast<std::int32_t>(solids.ids()[i]);
    interface.tag(fields::source_set)[to] = number;
    interface.vector(fields::position)[to] = solids.vector(fields::position)[i];
    interface.vector(fields::velocity)[to] = solids.vector(fields::velocity)[i];
    // Volume of the cell that the particle occupies.
    interface.scalar(fields::reference_volume)[to] = std::pow(solids.spacing(), Dim);
    interface.scalar(fields::no_slip)[to] = solid_of(model, body)->slip == "no_slip" ? 1 : 0;
    const Vec3 normal =
        outward_normal(*body.shape, to_space<Dim>(solids.vector(fields::reference_position)[i]),
                       0.5 * solids.spacing(), Dim);
    interface.vector(fields::normal)[to] = interface.vector(fields::reference_normal)[to] =
        to_scene<Dim>(normal);
  }
}

}  // namespace

template <int Dim>
void add_interface(Scene<Dim>& scene, const Model& model, Filling filling) {
  if (!has_interface(model)) return;
  World<Dim>& world = *scene.world;
  double h = 0, spacing = 0;
  for (const auto& set : world.sets())
    if (set->phase() == "solid") {
      h = std::max(h, set->smoothing_length());
      spacing = std::max(spacing, set->spacing());
    }
  // A quarter more than a kernel: lists of contacts hold for an advection step, in which two bodies
  // may come 0.4 h closer. And the range of contact with walls, 1.5 of their spacings.
  ParticleSet<Dim>& interface =
      world.add_set("interface", "wall", spacing, std::max(1.25 * h, 1.6 * model.resolution), true);
  for (const FieldSpec* f : {&fields::normal, &fields::reference_normal, &fields::no_slip,
                             &fields::source, &fields::source_set, &fields::reference_volume})
    interface.require(*f);
  if (filling == Filling::none) return;
  const double depth = interface_depth(model);
  std::int32_t number = 0;
  for (const auto& set : world.sets())
    if (set->phase() == "solid") follow(interface, *set, number++, model, depth);
}

template void add_interface<2>(Scene<2>&, const Model&, Filling);
template void add_interface<3>(Scene<3>&, const Model&, Filling);

}  // namespace sphgeo
