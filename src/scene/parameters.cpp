#include "scene/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "boundaries/boundary.h"
#include "boundaries/exchange.h"
#include "materials/soil.h"
#include "materials/solid.h"
#include "materials/water.h"
#include "scene/soil.h"

namespace sphgeo {
namespace {

NumericsParameters compile_numerics(const Numerics& n) {
  NumericsParameters p;
  const auto geometry = [](const std::string& word) {
    return word == "frozen" ? PairGeometry::frozen : PairGeometry::current;
  };
  p.pair_precision = n.pair_precision == "single" ? PairPrecision::single : PairPrecision::full;
  p.pair_geometry = geometry(n.pair_geometry);
  p.soil_pair_geometry = geometry(n.soil_pair_geometry);
  p.cfl_acoustic = n.cfl_acoustic;
  p.cfl_advection = n.cfl_advection;
  p.cfl_solid = n.cfl_solid;
  p.time_step_factor = n.time_step_factor;
  p.advection_ratio_max = n.advection_ratio_max;
  p.density_reinitialization =
      n.density_reinitialization == "summation" ? DensityReinitialization::summation
      : n.density_reinitialization == "shepard" ? DensityReinitialization::shepard
                                                : DensityReinitialization::none;
  p.transport_velocity = n.transport_velocity;
  p.transport_velocity_soil = n.transport_velocity_soil;
  p.transport_coefficient = n.transport_coefficient;
  p.transport_at_surface = n.transport_at_surface == "tangential" ? SurfaceTransport::tangential
                                                                  : SurfaceTransport::none;
  p.transport_target_volume = n.transport_target_volume;
  p.transport_projection = n.transport_projection;
  p.transport_projection_threshold = n.transport_projection_threshold;
  p.soil_velocity_gradient = n.soil_velocity_gradient == "corrected" ? VelocityGradient::corrected
                                                                     : VelocityGradient::plain;
  p.volume_fraction_by_summation = n.volume_fraction_reinitialization == "summation";
  p.solid_gradient =
      n.solid_gradient == "quadratic" ? SolidGradient::quadratic : SolidGradient::linear;
  p.water_fraction_floor = n.water_fraction_floor;
  p.density_bound = n.density_bound;
  p.max_lost_fraction = n.max_lost_fraction;
  p.outside = n.outside == "stop" ? OutsideDomain::stop : OutsideDomain::remove;
  return p;
}

WaterParameters compile_water(const Model& model) {
  WaterParameters p;
  if (const auto* water = dynamic_cast<const Water*>(model.liquid())) {
    p.density = water->density;
    p.viscosity = water->viscosity;
  }
  p.limiter = model.numerics.limiter;
  p.follows_porosity = has_soil(model) && model.numerics.pore_water != "constant_volume";
  return p;
}

StressPointParameters plain(const DruckerPrager<double>& m) {
  return {m.bulk, m.shear, m.friction, m.dilation, m.strength, m.apex};
}

DragLaw drag_law(const Soil& soil) {
  const std::string law = soil.drag_law();
  return law == "darcy" ? DragLaw::darcy : law == "ergun" ? DragLaw::ergun : DragLaw::none;
}

SoilPart compile_soil_part(const Soil& soil, const Body& body, double density) {
  SoilPart p;
  p.is_soil = true;
  p.moves = soil.moves_by_forces();
  p.fixed = soil.skeleton == "fixed";
  p.grain_density = soil.density;
  p.density = density;
  p.sound_speed = std::sqrt(soil.bulk_modulus() / density);
  p.wave_speed = std::sqrt(soil.oedometric_modulus() / density);
  p.friction = soil.elastic() ? 0 : soil.tan_friction();
  p.constants = plain(soil.constants());
  p.wet_strength = soil.constants(1.0).strength;
  p.drag = drag_law(soil);
  p.hydraulic_conductivity = soil.hydraulic_conductivity.value_or(0);
  p.grain_size = soil.grain_size.value_or(0);
  p.drag_viscous = soil.drag_viscous;
  p.drag_inertial = soil.drag_inertial;
  p.velocity = &body.velocity;
  return p;
}

SolidPart compile_solid_part(const Model& model, std::size_t b) {
  SolidPart p;
  const Body& body = model.bodies[b];
  const SolidMaterial* solid = solid_of(model, body);
  if (solid == nullptr) return p;
  p.is_solid = true;
  p.set = solid_set_of(model, b);
  p.density = solid->density;
  p.contact_stiffness = solid->contact_stiffness();
  p.contact_damping = solid->contact_damping;
  p.friction = solid->friction;
  p.self_contact = body.self_contact;
  p.shape = body.shape.get();
  for (const ClampedRegion& c : body.clamped)
    p.clamped.push_back({c.shape.get(), c.motion ? &*c.motion : nullptr});
  if (const auto* elastic = dynamic_cast<const Elastic*>(solid)) {
    p.elastic = true;
    p.shear = elastic->shear_modulus();
    p.lame = elastic->lame();
    p.neo_hookean = elastic->law == "neo_hookean";
    p.wave_speed = elastic->wave_speed();
    p.damping = elastic->damping;
    p.viscosity = elastic->viscosity_factor * elastic->density * elastic->wave_speed();
  }
  return p;
}

InletParameters compile_inlet(const Inlet& inlet, const Model& model) {
  InletParameters p;
  p.name = inlet.name;
  p.layer = inlet.layer(model.resolution, model.dimension);
  p.across = inlet.axis(model.dimension);
  p.direction = inlet.velocity_at(inlet.from)[p.across] > 0 ? 1 : -1;
  p.velocity = &inlet.velocity;
  p.share = inlet.share;
  p.seed = static_cast<std::uint64_t>(inlet.seed);
  p.from = inlet.from;
  p.until = inlet.until;
  return p;
}

void add_boundary(const BoundarySpec& spec, const Model& model, Parameters& p) {
  BoundaryMotion& part = p.boundary_motions.emplace_back();
  part.name = spec.name;
  if (const auto* wall = dynamic_cast<const WallBoundary*>(&spec); wall && wall->motion) {
    part.motion = &*wall->motion;
    part.absorbs_waves = wall->motion->waves && wall->motion->waves->absorb;
  }
  if (const auto* inlet = dynamic_cast<const Inlet*>(&spec))
    p.inlets.push_back(compile_inlet(*inlet, model));
  if (const auto* reservoir = dynamic_cast<const Reservoir*>(&spec))
    p.reservoirs.push_back(
        {reservoir->name, reservoir->positions(model.resolution, model.dimension)});
  if (const auto* outlet = dynamic_cast<const Outlet*>(&spec))
    p.outlets.push_back({outlet->name, outlet->shape.get(), outlet->sets});
}

std::string place_text(const Model& model, const std::string& path) {
  const Place at = model.place_of(path);
  return fmt::format("{}:{}:{}", at.file, at.line, at.column);
}

}  // namespace

SoilParameters compile_soil(const Model& model, const std::vector<double>& densities) {
  SoilParameters all;
  all.limiter = model.numerics.limiter_soil.value_or(20.0 * model.dimension);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    SoilPart& part = all.of.emplace_back();
    const auto* soil = dynamic_cast<const Soil*>(model.material(body.material));
    if (soil == nullptr) continue;
    part = compile_soil_part(*soil, body, densities[b]);
    if (!all.first.is_soil) all.first = part;
    all.uniform = all.uniform && part.density == all.first.density &&
                  part.sound_speed == all.first.sound_speed;
    all.any_moves = all.any_moves || !part.fixed;
    if (!part.moves) continue;
    all.deformable = true;
    all.fastest = std::max(all.fastest, part.sound_speed);
    all.fastest_wave = std::max(all.fastest_wave, part.wave_speed);
  }
  return all;
}

Parameters compile_parameters(const Model& model) {
  Parameters p;
  p.gravity = model.gravity;
  if (model.body_force) {
    p.body_force = &*model.body_force;
    p.body_force_location = place_text(model, "body_force");
  }
  p.numerics = compile_numerics(model.numerics);
  p.water = compile_water(model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    p.solids.of.push_back(compile_solid_part(model, b));
    p.bodies.push_back({model.bodies[b].name, place_text(model, fmt::format("bodies[{}]", b))});
  }
  for (std::size_t k = 0; k < model.boundaries.size(); ++k) {
    add_boundary(*model.boundaries[k], model, p);
    p.boundaries.push_back(
        {model.boundaries[k]->name, place_text(model, fmt::format("boundaries[{}]", k))});
  }
  p.without = model.without;
  p.shortest_interval = model.run_interval();
  for (const auto& probe : model.probes)
    p.shortest_interval = std::min(p.shortest_interval, model.probe_interval(*probe));
  return p;
}

}  // namespace sphgeo
