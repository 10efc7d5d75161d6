#include "scene/wall_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "boundaries/exchange.h"
#include "core/indices_where.h"
#include "core/parallel.h"
#include "geometry/shapes.h"
#include "probes/probe.h"
#include "scene/shadow.h"

namespace sphgeo {
namespace {

std::string point_text(const Vec3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", p.x(), p.y(), p.z());
}

/// A boundary with the solid it was made from.
struct Solid {
  std::string path;
  const WallBoundary* wall;
  std::shared_ptr<const Shape> shape;  ///< null: none
  bool in_place;                       ///< at t = 0 at the position of its shape
  Vec3 origin = Vec3::Zero();          ///< where the motion puts the point zero at t = 0
  Mat3 turn = Mat3::Identity();

  /// The point of the shape that is at a position at t = 0.
  Vec3 at_rest(const Vec3& at) const { return turn.transpose() * (at - origin); }
};

template <int Dim>
std::vector<Solid> solids_of(const Model& model) {
  std::vector<Solid> solids;
  const Placement placement{model.resolution, support_radius(model), Dim};
  for (std::size_t b = 0; b < model.boundaries.size(); ++b) {
    const auto* found = dynamic_cast<const WallBoundary*>(model.boundaries[b].get());
    if (found == nullptr) continue;
    const WallBoundary& wall = *found;
    Solid s{fmt::format("boundaries[{}]", b), &wall, wall.solid(placement), true};
    if (wall.motion) {
      s.origin = wall.motion->position(Vec3::Zero(), 0);
      for (int k = 0; k < 3; ++k)
        s.turn.col(k) = wall.motion->position(Vec3::Unit(k), 0) - s.origin;
      for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)})
        s.in_place = s.in_place && (wall.motion->position(p, 0) - p).norm() < 1e-9;
    }
    solids.push_back(std::move(s));
  }
  return solids;
}

template <int Dim>
void check_solid(const Scene<Dim>& scene, const Solid& s, Diagnostics& found) {
  const Model& model = *scene.model;
  if (s.shape) {
    CheckContext context(found, model.places, s.path + ".shape", model.dimension, model.resolution);
    s.shape->inspect(context);
  }
  const auto filled = std::find_if(scene.boundary_particles.begin(), scene.boundary_particles.end(),
                                   [&](const auto& p) { return p.first == s.wall->name; });
  // A tank of which only front and back are closed has no walls in 2D, which is no error.
  const bool across =
      Dim == 2 && s.wall->open_faces({model.resolution, support_radius(model), 2}).size() == 4;
  if (filled != scene.boundary_particles.end() && filled->second == 0 && !across)
    found.error(
        "E143", model.place_of(s.path), s.path,
        fmt::format("boundary '{}' holds no particle: water passes through it", s.wall->name),
        fmt::format("make it at least one spacing ({} m) thick, or refine the resolution",
                    model.resolution));
  if (!s.shape || s.shape->type != "box") return;
  const Aabb box = s.shape->box();
  for (int k = 0; k < 3; ++k) {
    if (k == 1 && Dim == 2) continue;
    const double length = box.hi[k] - box.lo[k], cells = length / model.resolution;
    if (std::abs(cells - std::round(cells)) < 1e-6 * cells + 1e-6 || std::round(cells) < 1)
      continue;
    found.warning(
        "W122", model.place_of(s.path + ".shape"), s.path + ".shape",
        fmt::format("the length of boundary '{}' along {} is {:.4g} spacings, no whole number",
                    s.wall->name, "xyz"[k], cells),
        fmt::format("its face at {} = {:.6g} m acts {:.2g} spacings away from there; a resolution "
                    "of {:.6g} m would fit",
                    "xyz"[k], box.hi[k], std::abs(cells - std::floor(cells + 0.5)),
                    length / std::round(cells)));
  }
}

// Particles deep in a solid, where there are no wall particles. What is near its surface is found
// by check_in_walls, also for moving boundaries. Clamped particles may lie there.
template <int Dim>
void check_deep_in_solid(const Model& model, const ParticleSet<Dim>& set, const Solid& s,
                         Diagnostics& found) {
  if (!s.shape) return;
  const Aabb box = s.shape->box();
  const auto& x = set.vector(fields::position);
  const auto* clamp = set.has(fields::clamp) ? &set.tag(fields::clamp) : nullptr;
  // Particles finer than those of walls slip between them.
  const double reach =
      set.spacing() < 0.99 * model.resolution ? 0.3 * set.spacing() : support_radius(model);
  const auto deep = [&](Index i) {
    const Vec3 at = s.at_rest(to_space<Dim>(x[i]));
    return !(clamp && (*clamp)[i] >= 0) && box.contains(at) && s.shape->bound(at) < 0 &&
           s.shape->signed_distance(at) < -reach;
  };
  const double count = ordered_sum(set.size(), [&](Index i) { return deep(i) ? 1.0 : 0.0; });
  if (!(count > 0)) return;
  Index first = 0;
  while (!deep(first)) ++first;
  const auto body = static_cast<std::size_t>(set.tag(fields::part)[first]);
  const std::string path = fmt::format("bodies[{}].shape", body);
  for (const Diagnostic& d : found.items())
    if (d.id == "E121" && d.path == path) return;
  found.error(
      "E121", model.place_of(path), path,
      fmt::format("body '{}' overlaps boundary '{}': {:.0f} particles lie in the solid, one at {}",
                  model.bodies[body].name, s.wall->name, count,
                  point_text(to_space<Dim>(x[first]))),
      "let the body end at the surface of the wall");
}

// Water and soil pass a wall of one layer of particles.
template <int Dim>
void check_thickness(const Model& model, const World<Dim>& world, const std::vector<Solid>& solids,
                     Diagnostics& found) {
  const ParticleSet<Dim>* walls = world.find("walls");
  if (!walls || (!world.find("water") && !world.find("soil"))) return;
  constexpr double least = 1.75;  // spacings; two layers fit into more
  constexpr Index most_samples = 2000;
  const double dp = model.resolution;
  const auto in_some_solid = [&](const Vec3& at) {
    return std::any_of(solids.begin(), solids.end(), [&](const Solid& s) {
      return s.shape && s.in_place && s.shape->box().contains(at) &&
             s.shape->bound(at) < 1e-6 * dp;  // also on a joint of two
    });
  };
  const auto& x = walls->vector(fields::position);
  const auto& normal = walls->vector(fields::normal);
  const auto& part = walls->tag(fields::part);
  for (std::size_t b = 0; b < model.boundaries.size(); ++b) {
    const auto s = std::find_if(solids.begin(), solids.end(), [&](const Solid& one) {
      return one.wall == model.boundaries[b].get();
    });
    if (s == solids.end() || !s->shape || !s->in_place) continue;
    const auto own = indices_where(
        walls->size(), [&](Index i) { return part[i] == static_cast<std::int32_t>(b); });
    const Index stride = 1 + static_cast<Index>(own.size()) / most_samples;
    Index samples = 0, thin = 0;
    double sum = 0;
    for (std::size_t k = 0; k < own.size(); k += static_cast<std::size_t>(stride)) {
      const Vec3 at = to_space<Dim>(x[own[k]]), out = to_space<Dim>(normal[own[k]]);
      const double depth = -s->shape->signed_distance(at);
      // The first layer behind the face that the normal looks out of.
      if (!(depth < dp) || in_some_solid(at + (depth + 0.1 * dp) * out)) continue;
      ++samples;
      double thickness = 0.1;
      while (thickness < least && in_some_solid(at + (depth - thickness * dp) * out))
        thickness += 0.05;
      if (thickness >= least) continue;
      ++thin;
      sum += thickness;
    }
    if (!(2 * thin > samples)) continue;
    const std::string path = fmt::format("boundaries[{}].shape", b);
    found.warning(
        "W149", model.place_of(path), path,
        fmt::format("boundary '{}' is about {:.2g} spacings thick: water and soil leak through "
                    "walls of less than two",
                    s->wall->name, sum / static_cast<double>(thin)),
        fmt::format("make it {:.4g} m thick or more, or refine the resolution to {:.2g} m", 2 * dp,
                    sum / static_cast<double>(thin) * dp / 2));
  }
}

// Water leaves through an inlet when nothing stands behind it and what is before it pushes.
template <int Dim>
void check_inlets(const Model& model, const std::vector<Solid>& solids, Diagnostics& found) {
  for (std::size_t b = 0; b < model.boundaries.size(); ++b) {
    const auto* inlet = dynamic_cast<const Inlet*>(model.boundaries[b].get());
    if (!inlet || inlet->share < 1) continue;  // rain
    const Vec3 flow = inlet->velocity_at(inlet->from);
    const int across = inlet->axis(Dim);
    Vec3 back = Vec3::Zero();
    back[across] = flow[across] > 0 ? -1 : 1;
    // From above, water falls away from the inlet.
    if (back.dot(model.gravity) < -0.5 * model.gravity.norm()) continue;
    const std::vector<Vec3> layer = inlet->layer(model.resolution, Dim);
    const auto closed = [&](const Vec3& at) {
      for (const double way : {0.5, 1.0, 1.5, 2.0})
        for (const Solid& s : solids)
          if (s.shape && s.in_place && s.shape->bound(at + way * model.resolution * back) < 0)
            return true;
      return false;
    };
    const auto open =
        std::find_if(layer.begin(), layer.end(), [&](const Vec3& p) { return !closed(p); });
    if (open == layer.end()) continue;
    const std::string path = fmt::format("boundaries[{}]", b);
    found.add({Severity::note, "N153", model.place_of(path), path,
               fmt::format("nothing closes inlet '{}' from behind, at {} for one: water that is "
                           "pushed against it runs out of the scene there",
                           inlet->name, point_text(*open)),
               "a wall half a spacing to two spacings behind it keeps the water in"});
  }
}

void check_probes(const Model& model, const std::vector<Solid>& solids, Diagnostics& found) {
  for (std::size_t k = 0; k < model.probes.size(); ++k) {
    const auto& probe = dynamic_cast<const Probe&>(*model.probes[k]);
    for (const Vec3& at : probe.positions())
      for (const Solid& s : solids) {
        if (!s.shape || !s.in_place || s.wall->motion) continue;
        const double depth = s.shape->box().contains(at) ? -s.shape->signed_distance(at) : 0;
        // The outermost layer lies half a spacing below the surface: a probe within that distance
        // is accepted.
        if (depth < 0.5 * model.resolution + 1e-9) continue;
        const std::string path = fmt::format("probes[{}].at", k);
        found.warning(
            "W128", model.place_of(path), path,
            fmt::format("probe '{}' at {} lies inside boundary '{}', {:.3g} m below its surface",
                        probe.name, point_text(at), s.wall->name, depth),
            "move it to the surface or into the water");
        break;
      }
  }
}

// A body with no boundary anywhere below it, although the scene has boundaries.
template <int Dim>
void check_bodies_held(const Model& model, const World<Dim>& world, Diagnostics& found) {
  const ParticleSet<Dim>*water = world.find("water"), *walls = world.find("walls");
  if (!water || !walls || walls->size() == 0 || model.body_force || !(model.gravity.norm() > 0))
    return;
  int down = 0;
  model.gravity.cwiseAbs().maxCoeff(&down);
  if (std::abs(model.gravity[down]) < 0.999 * model.gravity.norm() || (Dim == 2 && down == 1))
    return;
  const auto& x = water->vector(fields::position);
  const auto& y = walls->vector(fields::position);
  Aabb all;
  for (Index i = 0; i < water->size(); ++i) all.extend(to_space<Dim>(x[i]));
  for (Index i = 0; i < walls->size(); ++i) all.extend(to_space<Dim>(y[i]));
  Shadow shadow(down, model.resolution, all);
  for (Index i = 0; i < walls->size(); ++i) shadow.add(to_space<Dim>(y[i]));
  std::vector<bool> held(model.bodies.size(), false), seen(held), moving(held);
  const auto& part = water->tag(fields::part);
  const auto& v = water->vector(fields::velocity);
  for (Index i = 0; i < water->size(); ++i) {
    const auto b = static_cast<std::size_t>(part[i]);
    seen[b] = true;
    moving[b] = moving[b] || v[i].squaredNorm() > 0;
    held[b] = held[b] || shadow.beyond(to_space<Dim>(x[i]), model.gravity[down] > 0);
  }
  for (std::size_t b = 0; b < held.size(); ++b) {
    if (!seen[b] || held[b] || moving[b]) continue;
    const std::string path = fmt::format("bodies[{}].shape", b);
    found.warning("W129", model.place_of(path), path,
                  fmt::format("there is no boundary below body '{}': it falls out of the scene",
                              model.bodies[b].name),
                  "move it over a boundary");
  }
}

}  // namespace

template <int Dim>
void check_walls(const Scene<Dim>& scene, Diagnostics& found) {
  const Model& model = *scene.model;
  const World<Dim>& world = *scene.world;
  const std::vector<Solid> solids = solids_of<Dim>(model);
  for (const Solid& s : solids) {
    check_solid(scene, s, found);
    for (const auto& set : world.sets())
      if (set->phase() != "wall" && set->name() != "interface")
        check_deep_in_solid(model, *set, s, found);
  }
  check_thickness(model, world, solids, found);
  check_inlets<Dim>(model, solids, found);
  check_probes(model, solids, found);
  check_bodies_held(model, world, found);
}

template void check_walls<2>(const Scene<2>&, Diagnostics&);
template void check_walls<3>(const Scene<3>&, Diagnostics&);

}  // namespace sphgeo
