#include "scene/soil.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "materials/soil.h"

namespace sphgeo {
namespace {

const Soil* soil_of(const Model& model, const Body& body) {
  return dynamic_cast<const Soil*>(model.material(body.material));
}

/// Volume fraction at t = 0; NaN when it is not given.
double initial_fraction(const Body& body, const Soil& soil, const Vec3& at) {
  if (body.volume_fraction) return (*body.volume_fraction)(at, 0);
  if (body.porosity) return 1 - (*body.porosity)(at, 0);
  return soil.volume_fraction.value_or(NAN);
}

/// Mean of the volume fraction over the particles of a body.
double mean_fraction(const Body& body, const Soil& soil, const BodyPoints& points) {
  double sum = 0;
  for (const Vec3& at : points.at) sum += initial_fraction(body, soil, at);
  return points.at.empty() ? 1 : sum / static_cast<double>(points.at.size());
}

/// Vertical stress by the weight of the soil between a position and the level, Pa, compression
/// negative.
double weight_above(const Body& body, const Soil& soil, const Model& model, const Vec3& at) {
  const double level = body.level.value_or(body.shape->box().hi.z());
  const double height = level - at.z();
  if (height <= 0) return 0;
  constexpr int parts = 64;  // midpoints, for a volume fraction that varies with height
  double sum = 0;
  for (int k = 0; k < parts; ++k)
    sum += initial_fraction(body, soil, {at.x(), at.y(), at.z() + height * (k + 0.5) / parts});
  return model.gravity.z() * soil.density * height * sum / parts;
}

Sym3 initial_stress(const Body& body, const Soil& soil, const Model& model, const Vec3& at) {
  Sym3 s = Sym3::Zero();
  if (body.stress_tensor)
    for (int k = 0; k < 6; ++k) s[k] = (*body.stress_tensor)[static_cast<std::size_t>(k)](at, 0);
  if (body.stress == "geostatic") {
    const double k0 = body.lateral_stress_ratio.value_or(soil.pressure_at_rest());
    s[2] = weight_above(body, soil, model, at);
    s[0] = s[1] = k0 * s[2];
  }
  return s;
}

/// The yield function of Eq. 12 over the strength at that pressure; positive outside.
double excess(const Sym3& stress, const DruckerPrager<double>& m) {
  const double s[6] = {stress[0], stress[1], stress[2], stress[3], stress[4], stress[5]};
  const StressInvariants<double> i(s);
  const double reach = m.strength - m.friction * i.first, root = std::sqrt(i.second);
  return root <= reach
             ? 0
             : (root - reach) / std::max(std::abs(m.friction * i.first) + m.strength, 1e-300);
}

template <int Dim>
void fill_one(ParticleSet<Dim>& set, const Model& model, std::size_t b, const Soil& soil,
              const BodyPoints& filling, Diagnostics& found) {
  const Body& body = model.bodies[b];
  const std::string path = fmt::format("bodies[{}]", b);
  const Index first = set.size();
  set.resize(first + static_cast<Index>(filling.at.size()));
  bool outside = false;
  for (std::size_t k = 0; k < filling.at.size(); ++k) {
    const Vec3& at = filling.at[k];
    const Index i = first + static_cast<Index>(k);
    const double n = initial_fraction(body, soil, at);
    const Sym3 stress = initial_stress(body, soil, model, at);
    const Vec<Dim> v = to_scene<Dim>(
        Vec3(body.velocity[0](at, 0), body.velocity[1](at, 0), body.velocity[2](at, 0)));
    if (!(n > 0 && n <= 1)) {
      found.error("E115", model.place_of(path), path,
                  fmt::format("the volume fraction of soil is {} at ({:.4g}, {:.4g}, {:.4g})", n,
                              at.x(), at.y(), at.z()),
                  "give volume_fraction (above 0, at most 1) of the material or of the body, or "
                  "the body's porosity");
      return;
    }
    const double wet = body.saturation(at, 0);
    if (!(wet >= 0 && wet <= 1)) {
      found.error("E116", model.place_of(path + ".saturation"), path + ".saturation",
                  fmt::format("the degree of saturation is {} at ({:.4g}, {:.4g}, {:.4g})", wet,
                              at.x(), at.y(), at.z()),
                  "it lies between 0 and 1");
      return;
    }
    if (!v.allFinite() || !stress.allFinite()) {
      found.error(
          "E111", model.place_of(path), path,
          fmt::format("the initial velocity or stress is not a number at ({:.4g}, {:.4g}, {:.4g})",
                      at.x(), at.y(), at.z()),
          "check the formulas there");
      return;
    }
    outside = outside || excess(stress, soil.constants()) > 1e-6;
    set.ids()[i] = static_cast<Id>(i);
    set.tag(fields::part)[i] = static_cast<std::int32_t>(b);
    set.vector(fields::position)[i] = to_scene<Dim>(at);
    set.vector(fields::velocity)[i] = soil.skeleton == "fixed" ? Vec<Dim>::Zero() : v;
    set.scalar(fields::mass)[i] = soil.density * n * filling.volume;
    set.scalar(fields::volume_fraction)[i] = n;
    set.scalar(fields::initial_volume_fraction)[i] = n;
    set.tensor(fields::stress)[i] = stress;
    set.tensor(fields::gradient_correction)[i] << 1, 1, 1, 0, 0, 0;
    if (set.has(fields::saturation)) set.scalar(fields::saturation)[i] = wet;
  }
  if (outside)
    found.warning("W117", model.place_of(path), path,
                  "the initial stress lies outside of the yield surface in some positions",
                  "the first step returns it to the yield surface; a larger lateral_stress_ratio "
                  "or cohesion would keep it");
}

}  // namespace

bool has_soil(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [&](const Body& b) { return soil_of(model, b) != nullptr; });
}

template <int Dim>
std::vector<double> add_soil(Scene<Dim>& scene, const Model& model, Filling filling,
                             Diagnostics& found) {
  std::vector<double> densities(model.bodies.size(), 0);
  if (!has_soil(model)) return densities;
  ParticleSet<Dim>& set =
      scene.world->add_set("soil", "soil", model.resolution, soil_smoothing_length(model), true);
  for (const FieldSpec* f :
       {&fields::mass, &fields::volume_fraction, &fields::volume_fraction_rate,
        &fields::initial_volume_fraction, &fields::stress, &fields::gradient_correction,
        &fields::plastic_strain, &fields::plastic_work})
    set.require(*f);
  for (const Body& b : model.bodies)
    if (const Soil* s = soil_of(model, b); s && s->saturated_cohesion)
      set.require(fields::saturation);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Soil* soil = soil_of(model, model.bodies[b]);
    if (!soil) continue;
    // Also for a resumed run: the reference density is that of these particles.
    const BodyPoints points = fill_body(model, b, found);
    densities[b] = soil->density * mean_fraction(model.bodies[b], *soil, points);
    if (filling == Filling::none || points.at.empty()) continue;
    scene.body_particles.push_back({model.bodies[b].name, static_cast<Index>(points.at.size()),
                                    filling_of(model.bodies[b], model)});
    fill_one(set, model, b, *soil, points, found);
  }
  return densities;
}

template std::vector<double> add_soil<2>(Scene<2>&, const Model&, Filling, Diagnostics&);
template std::vector<double> add_soil<3>(Scene<3>&, const Model&, Filling, Diagnostics&);

}  // namespace sphgeo
