#include "scene/solid.h"

#include <fmt/format.h>

#include "geometry/fill.h"
#include "materials/solid.h"
#include "scene/soil.h"

namespace sphgeo {
namespace {

/// Index of the first clamped region that contains the position, or -1.
std::int32_t clamp_of(const Body& body, const Vec3& at) {
  for (std::size_t k = 0; k < body.clamped.size(); ++k)
    if (body.clamped[k].shape->signed_distance(at) <= 0) return static_cast<std::int32_t>(k);
  return -1;
}

template <int Dim>
void fill_one(ParticleSet<Dim>& set, const Model& model, std::size_t b, const SolidMaterial& solid,
              const BodyPoints& filling, Diagnostics& found) {
  const Body& body = model.bodies[b];
  const std::string path = fmt::format("bodies[{}]", b);
  const Index first = set.size();
  set.resize(first + static_cast<Index>(filling.at.size()));
  // The weight of a boulder is that of its shape: its particles represent the volume of the shape,
  // not the cells of the lattice.
  const double volume =
      filling_of(body, model).relaxed
          ? filling.volume
          : cut_volume(*body.shape, set.spacing(), Dim) / static_cast<double>(filling.at.size());
  std::vector<Index> held(body.clamped.size(), 0);
  for (std::size_t k = 0; k < filling.at.size(); ++k) {
    const Vec3& at = filling.at[k];
    const Index i = first + static_cast<Index>(k);
    const std::int32_t clamp = clamp_of(body, at);
    Vec3 position = at,
         v(body.velocity[0](at, 0), body.velocity[1](at, 0), body.velocity[2](at, 0));
    if (clamp >= 0) {
      ++held[static_cast<std::size_t>(clamp)];
      const auto& motion = body.clamped[static_cast<std::size_t>(clamp)].motion;
      if (motion) position = motion->position(at, 0);
      v = motion ? motion->velocity(at, 0) : Vec3::Zero();
    }
    if (!v.allFinite() || !position.allFinite()) {
      found.error(
          "E111", model.place_of(path), path,
          fmt::format(
              "the initial velocity or position is not a number at ({:.4g}, {:.4g}, {:.4g})",
              at.x(), at.y(), at.z()),
          "check the formulas there");
      return;
    }
    set.ids()[i] = static_cast<Id>(i);
    set.tag(fields::part)[i] = static_cast<std::int32_t>(b);
    set.tag(fields::clamp)[i] = clamp;
    set.vector(fields::position)[i] = to_scene<Dim>(position);
    set.vector(fields::reference_position)[i] = to_scene<Dim>(at);
    set.vector(fields::velocity)[i] = to_scene<Dim>(v);
    set.scalar(fields::reference_volume)[i] = volume;
    set.scalar(fields::mass)[i] = solid.density * volume;
  }
  for (std::size_t k = 0; k < held.size(); ++k)
    if (held[k] == 0) {
      const std::string at = fmt::format("{}.clamped[{}].shape", path, k);
      found.warning("W118", model.place_of(at), at,
                    fmt::format("the region clamps no particle of body '{}'", body.name),
                    "it must overlap the body by half a spacing at least");
    }
}

/// Keys of solids only, or of elastic ones only.
void check_keys(const Model& model, Diagnostics& found) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const SolidMaterial* solid = solid_of(model, body);
    const auto refuse = [&](const char* key, bool given, const char* help) {
      const std::string path = fmt::format("bodies[{}].{}", b, key);
      if (given)
        found.error("E119", model.place_of(path), path,
                    fmt::format("'{}' has no meaning for body '{}', which is {}", key, body.name,
                                solid ? "rigid" : "not a solid"),
                    help);
    };
    if (!solid)
      refuse("spacing", body.spacing.has_value(),
             "water and soil have the deck's resolution; give the spacing of solids only");
    if (!solid || solid->rigid()) {
      refuse("clamped", !body.clamped.empty(),
             "use a boundary of type wall for a rigid solid that is fixed; elastic solids can be "
             "clamped in part");
      refuse("self_contact", body.self_contact,
             "only an elastic solid can be in contact with itself");
    }
  }
}

}  // namespace

template <int Dim>
void add_solids(Scene<Dim>& scene, const Model& model, Filling filling, Diagnostics& found) {
  check_keys(model, found);
  const std::vector<double> spacings = solid_spacings(model);
  for (std::size_t k = 0; k < spacings.size(); ++k) {
    const std::string name = solid_set_name(k);
    ParticleSet<Dim>& set = scene.world->add_solids(
        name, spacings[k], model.numerics.h_factor_solid.value_or(1.15) * spacings[k]);
    for (const FieldSpec* f : {&fields::clamp, &fields::acceleration}) set.require(*f);
    if (filling == Filling::none) continue;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const SolidMaterial* solid = solid_of(model, model.bodies[b]);
      if (!solid || solid_set_of(model, b) != name) continue;
      const BodyPoints points = fill_body(model, b, found);
      if (points.at.empty()) continue;
      scene.body_particles.push_back({model.bodies[b].name, static_cast<Index>(points.at.size()),
                                      filling_of(model.bodies[b], model)});
      fill_one(set, model, b, *solid, points, found);
    }
  }
}

template void add_solids<2>(Scene<2>&, const Model&, Filling, Diagnostics&);
template void add_solids<3>(Scene<3>&, const Model&, Filling, Diagnostics&);

}  // namespace sphgeo
