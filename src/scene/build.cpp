#include "scene/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "boundaries/exchange.h"
#include "core/error.h"
#include "core/parallel.h"
#include "materials/water.h"
#include "scene/body_filling.h"
#include "scene/extent.h"
#include "scene/interface.h"
#include "scene/join_walls.h"
#include "scene/output_check.h"
#include "scene/parameters.h"
#include "scene/pore_water.h"
#include "scene/soil.h"
#include "scene/solid.h"
#include "scene/wall_corners.h"

namespace sphgeo {

double water_smoothing_length(const Model& model) {
  return model.numerics.h_factor_water.value_or(1.8) * model.resolution;
}

double soil_smoothing_length(const Model& model) {
  return model.numerics.h_factor_soil.value_or(1.3) * model.resolution;
}

namespace {

bool has_water(const Model& model) {
  for (const auto& b : model.boundaries)
    if (const auto* border = dynamic_cast<const ExchangeBoundary*>(b.get());
        border && !border->source_box().empty())
      return true;
  return std::any_of(model.bodies.begin(), model.bodies.end(), [&](const Body& b) {
    const MaterialSpec* m = model.material(b.material);
    return m && m->phase() == "water";
  });
}

/// Whether there is soil and no water: then its kernel alone determines the wall thickness.
bool only_soil(const Model& model) { return has_soil(model) && !has_water(model); }

}  // namespace

double support_radius(const Model& model) {
  if (only_soil(model)) return 2 * soil_smoothing_length(model);
  return 2 * (has_soil(model)
                  ? std::max(water_smoothing_length(model), soil_smoothing_length(model))
                  : water_smoothing_length(model));
}

namespace {

/// Pressure at t = 0, Pa.
double initial_pressure(const Body& body, const Model& model, double density, const Vec3& at) {
  if (body.pressure.word == "zero") return 0;
  if (body.pressure.word == "hydraulic_head")
    return std::max(0.0, -density * model.gravity.z() * ((*body.head)(at, 0) - at.z()));
  if (body.pressure.word == "hydrostatic") {
    const double level = body.level.value_or(body.shape->box().hi.z());
    return std::max(0.0, -density * model.gravity.z() * (level - at.z()));
  }
  return body.pressure.formula(at, 0);
}

template <int Dim>
void add_water(Scene<Dim>& scene, const Model& model, Filling fill, Diagnostics& found) {
  const auto* water = dynamic_cast<const Water*>(model.liquid());
  if (!water || !has_water(model)) return;
  ParticleSet<Dim>& set =
      scene.world->add_set("water", "water", model.resolution, water_smoothing_length(model), true);
  for (const FieldSpec* f : {&fields::mass, &fields::density, &fields::density_rate})
    set.require(*f);
  if (fill == Filling::none) return;
  scene.pore_water =
      pore_water(model, found, fill == Filling::draft ? Relaxing::draft : Relaxing::as_deck);
  // Water of variable mass (Zhu et al.) starts on a lattice, and its mass follows the porosity.
  std::optional<WaterTarget> share;
  if (model.numerics.pore_water == "variable_mass" && has_soil(model)) share.emplace(model);
  if (found.has_errors()) return;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const MaterialSpec* material = model.material(body.material);
    if (!material || material->phase() != "water") continue;
    const std::string path = fmt::format("bodies[{}]", b);
    const std::vector<Vec3>* relaxed = scene.pore_water ? scene.pore_water->of_body(b) : nullptr;
    const BodyPoints filling = fill_body(model, b, found, relaxed);
    if (filling.at.empty()) continue;
    const Index first = set.size();
    set.resize(first + static_cast<Index>(filling.at.size()));
    scene.body_particles.push_back(
        {body.name, static_cast<Index>(filling.at.size()),
         relaxed ? FillingChoice{true, "it meets water in soil"} : filling_of(body, model)});
    const double mass = water->density * filling.volume, c2 = scene.sound.value * scene.sound.value;
    auto& x = set.vector(fields::position);
    auto& v = set.vector(fields::velocity);
    parallel_for(static_cast<Index>(filling.at.size()), [&](Index k) {
      const Vec3& at = filling.at[static_cast<std::size_t>(k)];
      const Index i = first + k;
      set.ids()[i] = static_cast<Id>(i);
      set.tag(fields::part)[i] = static_cast<std::int32_t>(b);
      x[i] = to_scene<Dim>(at);
      v[i] = to_scene<Dim>(
          Vec3(body.velocity[0](at, 0), body.velocity[1](at, 0), body.velocity[2](at, 0)));
      set.scalar(fields::mass)[i] =
          share ? mass * std::clamp(share->mean_fraction(at, model.resolution),
                                    WaterTarget::smallest, 1.0)
                : mass;
      set.scalar(fields::density)[i] =
          water->density + initial_pressure(body, model, water->density, at) / c2;
    });
    for (Index i = first; i < set.size(); ++i)
      if (!v[i].allFinite() || !std::isfinite(set.scalar(fields::density)[i])) {
        const Vec3 at = to_space<Dim>(x[i]);
        found.error(
            "E111", model.place_of(path), path,
            fmt::format(
                "the initial velocity or pressure is not a number at ({:.4g}, {:.4g}, {:.4g})",
                at.x(), at.y(), at.z()),
            "check the formulas there");
        break;
      }
  }
}

template <int Dim>
void add_walls(Scene<Dim>& scene, const Model& model, Filling fill, Diagnostics& found) {
  bool any = false, moves = false;
  for (const auto& b : model.boundaries) {
    const auto* wall = dynamic_cast<const WallBoundary*>(b.get());
    any = any || wall;
    moves = moves || (wall && wall->motion.has_value());
  }
  if (!any) return;
  const double dp = model.resolution;
  // Pairs use the larger smoothing length of both sets. Of one phase alone, that of the walls is no
  // larger than its own. With water and soil they are that of the larger one: the part of a kernel
  // that lies in walls is needed at both.
  const double h = only_soil(model) ? soil_smoothing_length(model)
                   : has_soil(model)
                       ? std::max(water_smoothing_length(model), soil_smoothing_length(model))
                       : water_smoothing_length(model);
  ParticleSet<Dim>& set = scene.world->add_set("walls", "wall", dp, h, moves);
  for (const FieldSpec* f : {&fields::normal, &fields::no_slip}) set.require(*f);
  if (has_soil(model)) set.require(fields::corner);
  if (moves)
    for (const FieldSpec* f :
         {&fields::acceleration, &fields::reference_position, &fields::reference_normal})
      set.require(*f);
  if (fill == Filling::none) return;
  const Placement placement{dp, support_radius(model), Dim};
  std::vector<WallPart> parts;
  for (std::size_t b = 0; b < model.boundaries.size(); ++b) {
    const auto* wall = dynamic_cast<const WallBoundary*>(model.boundaries[b].get());
    parts.push_back({});
    if (wall == nullptr) continue;
    parts.back() = {{}, wall->solid(placement), !wall->motion};
    try {
      parts.back().points = wall->points(placement);
    } catch (const Error& e) {
      const std::string path = fmt::format("boundaries[{}]", b);
      found.error("E144", model.place_of(path), path, e.what());
    }
  }
  const double g = model.gravity.norm();
  join_walls<Dim>(parts, dp, support_radius(model),
                  has_soil(model) && g > 0 ? Vec3(-model.gravity / g) : Vec3::Zero());
  if (has_soil(model)) mark_corners<Dim>(parts, dp, support_radius(model));
  for (std::size_t b = 0; b < model.boundaries.size(); ++b) {
    const auto* found_wall = dynamic_cast<const WallBoundary*>(model.boundaries[b].get());
    if (found_wall == nullptr) continue;
    const WallBoundary& wall = *found_wall;
    const std::vector<WallPoint>& points = parts[b].points;
    const Index first = set.size();
    set.resize(first + static_cast<Index>(points.size()));
    scene.boundary_particles.emplace_back(wall.name, static_cast<Index>(points.size()));
    auto& id = set.ids();
    auto& part = set.tag(fields::part);
    auto& position = set.vector(fields::position);
    auto& normal = set.vector(fields::normal);
    auto& no_slip = set.scalar(fields::no_slip);
    auto* corner = set.has(fields::corner) ? &set.scalar(fields::corner) : nullptr;
    auto* position_at_rest = moves ? &set.vector(fields::reference_position) : nullptr;
    auto* normal_at_rest = moves ? &set.vector(fields::reference_normal) : nullptr;
    const std::optional<Motion::Moment> at_start =
        wall.motion ? std::optional<Motion::Moment>(std::in_place, *wall.motion, 0, 0)
                    : std::nullopt;
    parallel_for(static_cast<Index>(points.size()), [&](Index k) {
      const WallPoint& point = points[static_cast<std::size_t>(k)];
      const Index i = first + k;
      id[i] = static_cast<Id>(i);
      part[i] = static_cast<std::int32_t>(b);
      if (moves) {
        (*position_at_rest)[i] = to_scene<Dim>(point.position);
        (*normal_at_rest)[i] = to_scene<Dim>(point.normal);
      }
      position[i] = to_scene<Dim>(at_start ? at_start->position(point.position) : point.position);
      normal[i] = to_scene<Dim>(at_start ? at_start->direction(point.normal) : point.normal);
      if (corner) (*corner)[i] = point.corner ? 1.0 : 0.0;
      no_slip[i] = wall.slip_kind() == Slip::no_slip ? 1.0 : 0.0;
    });
  }
}

/// Box of all bodies of the deck that are bounded, and of the walls' particles.
template <int Dim>
Aabb particles_box(const World<Dim>& world) {
  Aabb box;
  for (const auto& s : world.sets()) {
    const auto& x = s->vector(fields::position);
    for (Index i = 0; i < s->size(); ++i) box.extend(to_space<Dim>(x[i]));
  }
  return box;
}

template <int Dim>
void set_domain(World<Dim>& world, const Model& model) {
  Aabb box = particles_box(world);
  for (const auto& b : model.boundaries)
    if (const auto* border = dynamic_cast<const ExchangeBoundary*>(b.get()))
      box.extend(border->source_box());
  if (box.empty()) box = {Vec3::Zero(), Vec3::Zero()};
  // Particles that leave this box are lost: its margin on every side is the size of the scene.
  const double room = std::max((box.hi - box.lo).maxCoeff(), 10 * model.resolution);
  box = box.grown(room);
  if (model.numerics.domain_min) box.lo = *model.numerics.domain_min;
  if (model.numerics.domain_max) box.hi = *model.numerics.domain_max;
  world.set_domain(to_scene<Dim>(box.lo), to_scene<Dim>(box.hi));
}

Aabb water_box(const Model& model) {
  Aabb box;
  for (const Body& b : model.bodies)
    if (const MaterialSpec* m = model.material(b.material); m && m->phase() == "water" && b.shape)
      box.extend(b.shape->box());
  return box;
}

/// Water compressed by its own weight: g H / c0^2 of its density at the bottom.
void check_compression(const Model& model, const SoundSpeed& sound, Diagnostics& found) {
  const Aabb box = water_box(model);
  const double g = model.gravity.norm(), c = sound.value;
  // Without boundaries the water falls, and nothing presses on it.
  if (!(g > 0) || model.boundaries.empty() || box.empty() || !box.lo.allFinite() ||
      !box.hi.allFinite())
    return;
  const double depth = (box.hi - box.lo).cwiseProduct(model.gravity.cwiseAbs() / g).sum();
  const double compression = g * depth / (c * c);
  constexpr double noticeable = 0.05, senseless = 0.2;
  if (!(compression > noticeable)) return;
  const std::string message = fmt::format(
      "with a speed of sound of {:.3g} m/s water {:.3g} m deep is {:.2g} % denser at its bottom", c,
      depth, 100 * compression);
  const std::string help = fmt::format("1 % takes {:.3g} m/s: max_speed of the water is a tenth",
                                       std::sqrt(g * depth / 0.01));
  if (compression > senseless)
    found.error("E148", model.place_of("materials"), "materials", message, help);
  else found.warning("W137", model.place_of("materials"), "materials", message, help);
}

Aabb scene_box(const Model& model) {
  Aabb box = water_box(model);
  const Placement placement{model.resolution, support_radius(model), model.dimension};
  for (const auto& b : model.boundaries) {
    const auto* wall = dynamic_cast<const WallBoundary*>(b.get());
    const auto solid = wall ? wall->solid(placement) : nullptr;
    if (!solid || !solid->box().lo.allFinite()) continue;
    const Vec3 inner = solid->box().lo + Vec3::Constant(placement.thickness);
    box.extend(inner);
    if (solid->box().hi.allFinite())
      box.extend(inner.cwiseMax(solid->box().hi - Vec3::Constant(placement.thickness)));
  }
  return box;
}

}  // namespace

template <int Dim>
Scene<Dim> build_scene(const Model& model, Diagnostics& found, Filling filling) {
  Scene<Dim> scene;
  scene.model = &model;
  check_extent(model, found);
  check_outputs(model, found);
  if (found.has_errors()) throw DeckError(found);
  // What follows from the filling is added below; then nobody changes it any more.
  const auto parameters = std::make_shared<Parameters>(compile_parameters(model));
  scene.world = std::make_unique<World<Dim>>(parameters);
  scene.sound = water_sound_speed(model, water_box(model), scene_box(model));
  if (has_water(model) && !(scene.sound.value > 0)) {
    found.error("E112", model.place_of("materials"), "materials",
                "no speed of sound can be estimated: " + scene.sound.because,
                "give max_speed or sound_speed of the water");
    scene.sound.value = 1;
  }
  if (has_water(model)) check_compression(model, scene.sound, found);
  parameters->water.sound_speed = scene.sound.value;
  add_water(scene, model, filling, found);
  parameters->soil = compile_soil(model, add_soil(scene, model, filling, found));
  add_solids(scene, model, filling, found);
  add_walls(scene, model, filling, found);
  add_interface(scene, model, filling);
  if (filling != Filling::none) set_domain(*scene.world, model);
  return scene;
}

template Scene<2> build_scene<2>(const Model&, Diagnostics&, Filling);
template Scene<3> build_scene<3>(const Model&, Diagnostics&, Filling);

}  // namespace sphgeo
