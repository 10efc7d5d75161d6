#include "scene/cross_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/indices_where.h"
#include "core/parallel.h"
#include "core/text.h"
#include "effects/effect.h"
#include "geometry/shapes.h"
#include "materials/soil.h"
#include "materials/solid.h"
#include "probes/probe.h"
#include "scene/body_filling.h"
#include "scene/leak.h"
#include "scene/wall_check.h"

namespace sphgeo {
namespace {

std::string point_text(const Vec3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", p.x(), p.y(), p.z());
}

// A body's particle inside the shape of another body of the same phase, or of a solid, deeper than
// a quarter of the spacing.
template <int Dim>
void check_bodies_overlap(const Model& model, const ParticleSet<Dim>& set, Diagnostics& found) {
  if (model.bodies.size() < 2) return;
  const auto& x = set.vector(fields::position);
  const auto& part = set.tag(fields::part);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const MaterialSpec* m = model.material(model.bodies[b].material);
    if (!m || (m->phase() != set.phase() && m->phase() != "solid")) continue;
    const bool same = m->phase() == set.phase();
    const Aabb box = model.bodies[b].shape->box();
    std::vector<Index> inside(model.bodies.size(), 0);
    Vec3 example = Vec3::Zero();
    for (Index i = 0; i < set.size(); ++i) {
      const auto other = static_cast<std::size_t>(part[i]);
      const Vec3 at = to_space<Dim>(x[i]);
      if ((same && other >= b) || !box.contains(at))
        continue;  // two of one phase are compared once
      if (model.bodies[b].shape->signed_distance(at) > -0.25 * set.spacing()) continue;
      if (inside[other]++ == 0) example = at;
    }
    for (std::size_t other = 0; other < model.bodies.size(); ++other)
      if (inside[other] > 0) {
        const std::string path = fmt::format("bodies[{}].shape", b);
        found.error("E120", model.place_of(path), path,
                    fmt::format("body '{}' overlaps body '{}': {} particles lie in both, one at {}",
                                model.bodies[b].name, model.bodies[other].name, inside[other],
                                point_text(example)),
                    "move one of them, or subtract it with a shape of type difference");
      }
  }
}

// A particle that is free to move and starts closer to a wall particle than half a spacing is
// repelled strongly. Clamped particles do not move.
template <int Dim>
void check_in_walls(const Model& model, World<Dim>& world, const ParticleSet<Dim>& set,
                    Diagnostics& found) {
  const ParticleSet<Dim>* walls = world.find("walls");
  if (!walls || walls->size() == 0) return;
  CellGrid<Dim> grid;
  const auto& y = walls->vector(fields::position);
  const auto frame =
      FixedPoint<Dim>::fit(world.domain_lo(), world.domain_hi(), support_radius(model));
  grid.build({y.data(), static_cast<std::size_t>(y.size())}, frame, model.resolution);
  const auto& x = set.vector(fields::position);
  struct Clash {
    Index count = 0, body = -1, wall = -1;
    Vec3 at = Vec3::Zero();
  };
  const auto* clamp = set.has(fields::clamp) ? &set.tag(fields::clamp) : nullptr;
  // Threshold of the distance, in spacings.
  const auto nearer_than = [&](double spacings) {
    const auto wall_near = [&](Index i) {
      Index wall = -1;
      grid.for_each_in_reach(x[i], spacings * set.spacing(), [&](Index j, double) {
        if (wall < 0) wall = j;
      });
      return wall;
    };
    const auto close = indices_where(
        set.size(), [&](Index i) { return !(clamp && (*clamp)[i] >= 0) && wall_near(i) >= 0; });
    if (close.empty()) return Clash{};
    const Index first = close.front();
    return Clash{static_cast<Index>(close.size()), set.tag(fields::part)[first],
                 walls->tag(fields::part)[wall_near(first)], to_space<Dim>(x[first])};
  };
  const Clash clash = nearer_than(0.45);
  if (clash.count == 0 && set.phase() == "soil") {
    // Walls repel soil nearer than 0.85 spacings (see SoilWallPair), with its bulk modulus.
    const Clash repelled = nearer_than(0.7);
    if (repelled.count == 0) return;
    const std::string path = fmt::format("bodies[{}].shape", repelled.body);
    found.warning(
        "W134", model.place_of(path), path,
        fmt::format("soil overlaps the wall's contact range: {} of its particles lie nearer than "
                    "0.7 spacings to a wall particle, one of body '{}' at {}, beside boundary '{}'",
                    repelled.count, model.bodies[static_cast<std::size_t>(repelled.body)].name,
                    point_text(repelled.at),
                    model.boundaries[static_cast<std::size_t>(repelled.wall)]->name),
        "the initial repulsion adds energy; align the wall with the lattice, or start half a "
        "spacing away from it");
    return;
  }
  if (clash.count == 0) return;
  const std::string path = fmt::format("bodies[{}].shape", clash.body);
  found.error(
      "E121", model.place_of(path), path,
      fmt::format(
          "body '{}' overlaps boundary '{}': {} of its particles lie in the wall, one at {}",
          model.bodies[static_cast<std::size_t>(clash.body)].name,
          model.boundaries[static_cast<std::size_t>(clash.wall)]->name, clash.count,
          point_text(clash.at)),
      "let the body end at the surface of the wall");
}

// Kernels are made for rows a spacing apart; a few per cent do no harm.
template <int Dim>
void check_lengths(const Model& model, Diagnostics& found) {
  constexpr double most_stretch = 0.03;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const auto* box = dynamic_cast<const Box*>(body.shape.get());
    if (!box || filling_of(body, model).relaxed) continue;
    const double dp = body.spacing.value_or(model.resolution);
    for (int k = 0; k < 3; ++k) {
      if (k == 1 && Dim == 2) continue;
      const double length = box->max[k] - box->min[k],
                   rows = std::max(1.0, std::round(length / dp));
      if (std::abs(length / rows / dp - 1) <= most_stretch) continue;
      const std::string path = fmt::format("bodies[{}].shape", b);
      found.warning(
          "W122", model.place_of(path), path,
          fmt::format("the length of body '{}' along {} is {:.4g} spacings, no whole number",
                      body.name, "xyz"[k], length / dp),
          fmt::format("it is filled with {} rows, {:.2g} spacings apart; a resolution of {:.6g} m "
                      "would fit",
                      rows, length / rows / dp, length / rows));
    }
  }
}

// Names of the fields of a set that exist or that some effect of the scene computes.
template <int Dim>
std::vector<std::string> fields_of(const World<Dim>& world, const std::string& set) {
  std::set<std::string> names;
  for (const auto& [name, field] : world.find(set)->fields()) names.insert(name);
  const auto& off = world.parameters().without;
  for (const auto& entry : EffectRegistry::all())
    if (std::find(off.begin(), off.end(), entry.info.name) == off.end())
      for (const auto& effect : entry.template bind<Dim>(world).effects)
        for (const FieldUse& use : effect->needs().fields)
          if (use.set == set && !use.optional) names.insert(use.field->name);
  return {names.begin(), names.end()};
}

// Whether the scene has what a probe reads; if not, says so. `fields` are those of each set that
// has been looked at.
template <int Dim>
bool can_be_read(const Probe& probe, const FieldRequest& r, const World<Dim>& world,
                 std::map<std::string, std::vector<std::string>>& fields, CheckContext& context) {
  if (!world.find(r.set)) {
    std::vector<std::string> names;
    for (const auto& s : world.sets()) names.push_back(s->name());
    context.error(context.given("set") ? "set" : "",
                  fmt::format("probe '{}' needs the particle set '{}', which this scene does not "
                              "have",
                              probe.name, r.set),
                  names.empty() ? "" : "there are: " + in_words(names), "E124");
    return false;
  }
  if (!fields.contains(r.set)) fields[r.set] = fields_of(world, r.set);
  const std::vector<std::string>& names = fields[r.set];
  if (std::find(names.begin(), names.end(), r.field->name) != names.end()) return true;
  context.error(context.given("field") ? "field"
                : context.given("set") ? "set"
                                       : "",
                fmt::format("probe '{}' needs the field '{}', which the set '{}' does not have in "
                            "this scene",
                            probe.name, r.field->name, r.set),
                fmt::format("the fields of '{}' are {}", r.set, in_words(names)), "E125");
  return false;
}

template <int Dim>
void check_probes(const Model& model, const World<Dim>& world, Diagnostics& found) {
  Aabb box;
  for (const auto& s : world.sets()) {
    const auto& x = s->vector(fields::position);
    for (Index i = 0; i < s->size(); ++i) box.extend(to_space<Dim>(x[i]));
  }
  if (Dim == 2) {
    box.lo.y() = -INFINITY;
    box.hi.y() = INFINITY;
  }
  std::map<std::string, std::vector<std::string>> fields;
  for (std::size_t k = 0; k < model.probes.size(); ++k) {
    const std::string path = fmt::format("probes[{}]", k);
    const auto& probe = dynamic_cast<const Probe&>(*model.probes[k]);
    CheckContext context(found, model.places, path, model.dimension, model.resolution);
    const std::size_t sound = found.items().size();
    probe.inspect(model, context);
    const bool misread = found.items().size() > sound;  // one reason is enough
    for (const Vec3& at : probe.positions())
      if (!box.grown(model.resolution).contains(at))
        found.warning(
            "W123", model.place_of(path + ".at"), path + ".at",
            fmt::format("probe '{}' at {} lies outside of the scene", probe.name, point_text(at)),
            fmt::format("the scene spans x from {:.4g} to {:.4g} m and z from {:.4g} to {:.4g} m",
                        box.lo.x(), box.hi.x(), box.lo.z(), box.hi.z()));
    for (const FieldRequest& r : probe.needs(model))
      if (misread || (!r.optional && !can_be_read(probe, r, world, fields, context))) break;
  }
}

bool is_used(const Model& model, const MaterialSpec* material) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [&](const Body& b) { return model.material(b.material) == material; });
}

// A skeleton that water alone touches needs no stiffness: what else touches it is repelled with it,
// and of soil alone it sets the time step.
template <int Dim>
void check_stiffness(const Model& model, const World<Dim>& world, Diagnostics& found) {
  if (!world.find("soil")) return;
  const SoilParameters& soils = world.parameters().soil;
  const bool solids = std::any_of(world.sets().begin(), world.sets().end(),
                                  [](const auto& s) { return s->phase() == "solid"; });
  const char* needed = solids                 ? "solids can touch it"
                       : soils.deformable     ? "soil that deforms can touch it"
                       : !world.find("water") ? "there is no water, which alone sets a time step"
                                              : nullptr;
  if (!needed) return;
  for (std::size_t k = 0; k < model.materials.size(); ++k) {
    const auto* soil = dynamic_cast<const Soil*>(model.materials[k].get());
    if (!soil || soil->youngs_modulus || !is_used(model, soil)) continue;
    const std::string path = fmt::format("materials[{}]", k);
    found.error("E154", model.place_of(path), path,
                fmt::format("soil '{}' has no youngs_modulus, and {}", soil->name, needed),
                "give it, as in 'youngs_modulus: 10 MPa'");
  }
}

// Without a drag law water and soil interact by pressure only.
template <int Dim>
void check_coupling(const Model& model, const World<Dim>& world, Diagnostics& found) {
  if (!world.find("soil") || !world.find("water")) return;
  for (std::size_t k = 0; k < model.materials.size(); ++k) {
    const auto* soil = dynamic_cast<const Soil*>(model.materials[k].get());
    if (!soil || soil->drag != "auto" || soil->drag_law() != "none" || !is_used(model, soil))
      continue;
    const std::string path = fmt::format("materials[{}]", k);
    found.warning("W130", model.place_of(path), path,
                  fmt::format("water passes through soil '{}' without drag", soil->name),
                  "give grain_size (Ergun) or hydraulic_conductivity (Darcy), or say 'drag: none'");
  }
}

// An effect that a deck switches off must be one that can be, and the warning states what that
// means.
void check_switched_off(const Model& model, Diagnostics& found) {
  std::vector<std::string> can, all;
  for (const auto& entry : EffectRegistry::all()) {
    all.push_back(entry.info.name);
    if (!entry.info.when_off.empty()) can.push_back(entry.info.name);
  }
  for (std::size_t k = 0; k < model.without.size(); ++k) {
    const std::string& name = model.without[k];
    const std::string path = fmt::format("without[{}]", k);
    if (std::find(can.begin(), can.end(), name) != can.end()) {
      for (const auto& entry : EffectRegistry::all())
        if (entry.info.name == name)
          found.warning("W140", model.place_of(path), path,
                        fmt::format("effect '{}' is switched off: {}", name, entry.info.when_off),
                        "");
    } else if (std::find(all.begin(), all.end(), name) != all.end()) {
      found.error("E141", model.place_of(path), path,
                  fmt::format("effect '{}' cannot be switched off", name),
                  "these can: " + in_words(can));
    } else {
      const std::string near = suggestion(name, all);
      found.error("E141", model.place_of(path), path, fmt::format("there is no effect '{}'", name),
                  (near.empty() ? "" : near + " ") + "these can be switched off: " + in_words(can));
    }
  }
}

// Measured at CFL numbers up to 1: water at rest, water that hits a ceiling and collapsing sand are
// stable at 0.8 and not at 1, a vibrating plate at 0.9 and not at 1.
void check_steps(const Model& model, Diagnostics& found) {
  const auto warn = [&](const char* key, double value, double holds) {
    if (!(value * model.numerics.time_step_factor > holds)) return;
    const std::string path = fmt::format("numerics.{}", key);
    found.warning("W136", model.place_of(path), path,
                  fmt::format("runs become unstable when {} is near 1", key),
                  fmt::format("most hold at {} or less", holds));
  };
  warn("cfl_acoustic", model.numerics.cfl_acoustic, 0.8);
  warn("cfl_solid", model.numerics.cfl_solid, 0.9);
}

void check_shapes(const Model& model, Diagnostics& found) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    CheckContext context(found, model.places, fmt::format("bodies[{}].shape", b), model.dimension,
                         model.resolution);
    model.bodies[b].shape->inspect(context);
  }
}

}  // namespace

template <int Dim>
void check_scene(const Scene<Dim>& scene, Diagnostics& found) {
  const Model& model = *scene.model;
  World<Dim>& world = *scene.world;
  check_shapes(model, found);
  check_switched_off(model, found);
  check_steps(model, found);
  for (const auto& set : world.sets()) {
    if (set->phase() == "wall") continue;
    check_bodies_overlap(model, *set, found);
    check_in_walls(model, world, *set, found);
  }
  check_stiffness(model, world, found);
  check_coupling(model, world, found);
  check_lengths<Dim>(model, found);
  check_probes(model, world, found);
  check_walls(scene, found);
  check_leaks(scene, found);
}

template void check_scene<2>(const Scene<2>&, Diagnostics&);
template void check_scene<3>(const Scene<3>&, Diagnostics&);

}  // namespace sphgeo
