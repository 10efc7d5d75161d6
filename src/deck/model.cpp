#include "deck/model.h"

namespace sphgeo {

Schema<ClampedRegion> ClampedRegion::schema() {
  Schema<ClampedRegion> s("clamped region",
                          "A part of a solid body that is fixed, or moves as prescribed.");
  s.required("shape", &ClampedRegion::shape, unit::none,
             "the region; the part of the body inside it at t = 0 is clamped");
  s.optional("motion", &ClampedRegion::motion, unit::none,
             "prescribed motion; without one the region is fixed");
  return s;
}

Schema<Body> Body::schema() {
  Schema<Body> s(
      "body",
      "A region filled with particles of one material at t = 0; with `copies`, many of them.");
  s.taken_before("copies");
  s.taken_before("around");
  s.required("name", &Body::name, unit::none, "the name of its particles and files");
  s.required("material", &Body::material, unit::none, "the name of an entry of 'materials'");
  s.required("shape", &Body::shape, unit::none, "the region it fills");
  s.optional(
       "filling", &Body::filling, unit::none,
       "lattice: points of a square (cubic) lattice; relaxed: body-fitted by relaxation; auto: "
       "relaxed for rigid solids with faces that are not along the axes")
      .choices({"auto", "lattice", "relaxed"});
  s.optional("velocity", &Body::velocity, unit::speed, "initial velocity, formulas of x, y, z")
      .only_of("xyz");
  s.optional("pressure", &Body::pressure, unit::pressure,
             "initial pressure: zero, hydrostatic below 'level', hydraulic_head: that of the "
             "'head', or a formula "
             "of x, y, z")
      .choices({"zero", "hydrostatic", "hydraulic_head"})
      .only_of("xyz");
  s.optional("head", &Body::head, unit::length,
             "hydraulic head for pressure: hydraulic_head, the z of the piezometric level, a "
             "formula of x, y, z")
      .only_of("xyz");
  s.optional("level", &Body::level, unit::length,
             "z of the free surface for hydrostatic pressure; auto: the top of the body");
  s.optional(
       "stress", &Body::stress, unit::none,
       "initial stress of soil: zero, or geostatic: by the weight of the soil above, up to 'level'")
      .choices({"zero", "geostatic"});
  s.optional(
       "stress_tensor", &Body::stress_tensor, unit::pressure,
       "initial stress of soil, formulas of x, y, z: xx, yy, zz, xy, yz, xz; tension is positive")
      .items(6, 6)
      .only_of("xyz");
  s.optional(
       "lateral_stress_ratio", &Body::lateral_stress_ratio, unit::none,
       "horizontal over vertical geostatic stress, K0; auto: 1 - sin phi, or nu / (1 - nu) of an "
       "elastic soil")
      .at_least(0);
  s.optional(
       "volume_fraction", &Body::volume_fraction, unit::none,
       "initial volume fraction of soil, a number or a formula of x, y, z; auto: the material's")
      .only_of("xyz")
      .equation("Eq. 1");
  s.optional("porosity", &Body::porosity, unit::none,
             "initial porosity of soil, 1 - volume_fraction, instead of it")
      .only_of("xyz")
      .equation("Eq. 1");
  s.optional("saturation", &Body::saturation, unit::none,
             "initial degree of saturation of soil; used only with a saturated_cohesion")
      .only_of("xyz")
      .equation("Eq. 108");
  s.optional("spacing", &Body::spacing, unit::length,
             "particle spacing of a solid, where it differs from the deck's resolution; auto: the "
             "resolution")
      .above(0)
      .equation("section 3.5");
  s.optional("clamped", &Body::clamped, unit::none,
             "parts of an elastic solid that are fixed or move as prescribed")
      .items(0, 1000);
  s.optional("self_contact", &Body::self_contact, unit::none,
             "whether parts of an elastic solid may come into contact with each other")
      .equation("Eq. 78");
  s.check([](Body& b, CheckContext& c) {
    if (b.level && b.pressure.word != "hydrostatic" && b.stress != "geostatic") {
      c.error("level", "'level' has no meaning unless pressure is hydrostatic",
              "set pressure: hydrostatic (of water) or stress: geostatic (of soil), or leave "
              "'level' out");
    }
    if (b.head.has_value() != (b.pressure.word == "hydraulic_head"))
      c.error("head",
              b.head ? "'head' has no meaning unless pressure is hydraulic_head"
                     : "pressure: hydraulic_head needs a 'head'",
              "give both, as in 'pressure: hydraulic_head' and 'head: 1.5 m', or none of them");
    if (b.stress_tensor && b.stress != "zero")
      c.error("stress_tensor", "the initial stress is given twice",
              "give stress or stress_tensor, not both");
    if (b.lateral_stress_ratio && b.stress != "geostatic")
      c.error("lateral_stress_ratio",
              "'lateral_stress_ratio' has no meaning unless stress is geostatic");
    if (b.volume_fraction && b.porosity)
      c.error("porosity", "the volume fraction is given twice",
              "give volume_fraction or porosity, not both");
  });
  return s;
}

Schema<Numerics> Numerics::schema() {
  Schema<Numerics> s("numerics",
                     "Choices of the numerical method; the defaults are those of the paper.");
  s.optional("pair_precision", &Numerics::pair_precision, unit::none,
             "arithmetic of pair sums: single is faster; the state is double in both cases")
      .choices({"single", "double"});
  s.optional("pair_geometry", &Numerics::pair_geometry, unit::none,
             "positions used in pair sums: frozen as in Algorithm 2, or current")
      .choices({"frozen", "current"});
  s.optional("cfl_acoustic", &Numerics::cfl_acoustic, unit::none,
             "acoustic step as a fraction of h / (c + |v|)")
      .above(0)
      .at_most(1);
  s.optional("cfl_advection", &Numerics::cfl_advection, unit::none,
             "advection step as a fraction of h / |v|max")
      .above(0)
      .at_most(1);
  s.optional("time_step_factor", &Numerics::time_step_factor, unit::none,
             "factor on all time steps of all phases; 0.5 shows the influence of the time step on "
             "a result")
      .above(0)
      .at_most(1);
  s.optional(
       "lattice_jitter", &Numerics::lattice_jitter, unit::none,
       "largest random displacement of each coordinate of a particle from its lattice point at t = "
       "0, in spacings; bodies of water in contact with pore water are relaxed and not jittered")
      .at_least(0)
      .at_most(0.4);
  s.optional("lattice_seed", &Numerics::lattice_seed, unit::none,
             "another seed gives another jitter")
      .at_least(0);
  s.optional("advection_ratio_max", &Numerics::advection_ratio_max, unit::none,
             "largest advection step, in acoustic steps of a fluid at rest")
      .at_least(1);
  s.optional("limiter", &Numerics::limiter, unit::none,
             "factor of the low-dissipation limiter of water's Riemann flux")
      .at_least(0)
      .equation("Eq. 63");
  s.optional("transport_coefficient", &Numerics::transport_coefficient, unit::none,
             "strength alpha of the transport-velocity correction")
      .at_least(0)
      .at_most(1)
      .equation("Eq. 87");
  s.optional("density_reinitialization", &Numerics::density_reinitialization, unit::none,
             "summation: density from the sum over neighbors at each advection step; shepard: "
             "density smoothed by a "
             "first-order consistent filter at each advection step; none: never")
      .choices({"summation", "shepard", "none"});
  s.optional("pore_water", &Numerics::pore_water, unit::none,
             "water in soil: equal_mass: particles of one mass, whose volume follows the porosity; "
             "variable_mass: as well, but at t = 0 "
             "particles of one volume, whose mass follows the porosity (Zhu et al.); "
             "constant_volume: volume and mass ignore the "
             "porosity (Bui et al.)")
      .choices({"equal_mass", "variable_mass", "constant_volume"})
      .equation("Eq. 27");
  s.optional("water_fraction_floor", &Numerics::water_fraction_floor, unit::none,
             "lower bound of the water volume fraction where soil is dense; particles at the bound "
             "are counted")
      .above(0)
      .below(1)
      .equation("Eq. 56");
  s.optional("transport_target_volume", &Numerics::transport_target_volume, unit::none,
             "whether the transport-velocity correction of water in soil aims at the spacing that "
             "follows from the porosity")
      .equation("Eq. 88");
  s.optional("transport_projection", &Numerics::transport_projection, unit::none,
             "whether the transport-velocity correction omits its component along a steep gradient "
             "of porosity")
      .equation("Eq. 89");
  s.optional(
       "transport_projection_threshold", &Numerics::transport_projection_threshold, unit::none,
       "gradient of the water fraction, per smoothing length, above which the projection acts")
      .above(0)
      .equation("Eq. 89");
  s.optional("transport_velocity", &Numerics::transport_velocity, unit::none,
             "whether the transport-velocity correction acts on inner particles");
  s.optional("transport_at_surface", &Numerics::transport_at_surface, unit::none,
             "transport-velocity correction where the kernel support reaches the free surface: "
             "none, or its tangential component")
      .choices({"none", "tangential"})
      .equation("Eq. 87");
  s.optional("h_factor_water", &Numerics::h_factor_water, unit::none,
             "smoothing length of water in spacings; auto: 1.8")
      .at_least(1)
      .at_most(3);
  s.optional("h_factor_soil", &Numerics::h_factor_soil, unit::none,
             "smoothing length of soil in spacings; auto: 1.3")
      .at_least(1)
      .at_most(3);
  s.optional(
       "limiter_soil", &Numerics::limiter_soil, unit::none,
       "factor of the low-dissipation limiter of soil's Riemann flux; auto: 20 times the dimension")
      .at_least(0)
      .equation("Eq. 54");
  s.optional("soil_pair_geometry", &Numerics::soil_pair_geometry, unit::none,
             "positions used in pair sums of soil within an advection step; with frozen ones a "
             "rotating body shrinks, and the rate form of the stress keeps the error")
      .choices({"frozen", "current"});
  s.optional("soil_velocity_gradient", &Numerics::soil_velocity_gradient, unit::none,
             "corrected: exact for linear velocities also at surfaces; plain: the bare sum")
      .choices({"corrected", "plain"})
      .equation("Eq. 55");
  s.optional("volume_fraction_reinitialization", &Numerics::volume_fraction_reinitialization,
             unit::none,
             "summation: volume fraction of soil from the sum over neighbors at each advection "
             "step; none: "
             "never")
      .choices({"summation", "none"});
  s.optional("transport_velocity_soil", &Numerics::transport_velocity_soil, unit::none,
             "whether the transport-velocity correction acts on inner soil particles: for cohesive "
             "soil, against tensile instability")
      .equation("Eq. 87");
  s.optional("h_factor_solid", &Numerics::h_factor_solid, unit::none,
             "smoothing length of solids over their particle spacing; auto: 1.15")
      .at_least(0.8)
      .at_most(3)
      .equation("below Eq. 102");
  s.optional("solid_gradient", &Numerics::solid_gradient, unit::none,
             "fields whose gradient is exact: linear, as in Eq. 66, or quadratic also near "
             "surfaces, which gives plates of few layers their bending stiffness")
      .choices({"linear", "quadratic"})
      .equation("Eq. 66");
  s.optional("cfl_solid", &Numerics::cfl_solid, unit::none, "CFL number of the time step of solids")
      .above(0)
      .at_most(1)
      .equation("Eq. 94");
  s.optional("max_lost_fraction", &Numerics::max_lost_fraction, unit::none,
             "the run stops when more than this fraction of a set has left the domain or lies "
             "inside a wall")
      .at_least(0)
      .at_most(1)
      .changeable_on_resume();
  s.optional("density_bound", &Numerics::density_bound, unit::none,
             "the run stops when a density deviates from the reference density by more than this "
             "fraction")
      .above(0)
      .at_most(0.95)
      .changeable_on_resume();
  s.optional("outside", &Numerics::outside, unit::none,
             "what happens to particles that leave the domain")
      .choices({"remove", "stop"});
  s.optional("domain_min", &Numerics::domain_min, unit::length,
             "lower corner of the domain; auto: from bodies and boundaries");
  s.optional("domain_max", &Numerics::domain_max, unit::length,
             "upper corner of the domain; auto: from bodies and boundaries");
  s.check([](Numerics& n, CheckContext& c) {
    if (!n.domain_min || !n.domain_max) return;
    for (const int axis : {0, 1, 2}) {
      if (axis == 1 && c.dimension() == 2) continue;
      if ((*n.domain_min)[axis] < (*n.domain_max)[axis]) continue;
      c.error("domain_max", "the upper corner of the domain is not above the lower one");
      return;
    }
  });
  return s;
}

Schema<Relaxation> Relaxation::schema() {
  Schema<Relaxation> s("relaxation", "Initial distribution of pore water.");
  s.optional("steps", &Relaxation::steps, unit::none, "relaxation steps, at most")
      .at_least(0)
      .at_most(100000)
      .equation("Eq. 85");
  s.optional("seed", &Relaxation::seed, unit::none,
             "of the random draws that accept candidates: another seed gives another initial "
             "distribution")
      .at_least(0);
  s.optional("tolerance", &Relaxation::tolerance, unit::none,
             "mean displacement of a step, over the target spacing, below which the relaxation "
             "ends early")
      .at_least(0)
      .below(0.1);
  s.optional("acceptance", &Relaxation::acceptance, unit::none,
             "stratified: every part of the pores gets its share of particles; independent: each "
             "candidate is drawn by itself, and only the total is exact")
      .choices({"stratified", "independent"});
  s.optional(
       "file", &Relaxation::file, unit::none,
       "relaxed.h5 of 'sphgeo relax', to be used again; auto: relaxed when the scene is built")
      .changeable_on_resume();
  return s;
}

Schema<Frames> Frames::schema() {
  Schema<Frames> s("frames", "Particle frames for ParaView.");
  s.optional("every", &Frames::every, unit::time, "interval between frames; auto: end_time / 20")
      .above(0);
  s.optional("fields", &Frames::fields, unit::none,
             "fields to write; an empty list: the usual ones of each set");
  s.optional("precision", &Frames::precision, unit::none, "of real numbers in the files")
      .choices({"float32", "float64"});
  return s;
}

Schema<Output> Output::schema() {
  Schema<Output> s("output", "What a run writes, and how often.");
  s.optional("frames", &Output::frames, unit::none, "particle frames");
  s.optional("run_every", &Output::run_every, unit::time,
             "interval between rows of run.csv; auto: end_time / 200")
      .above(0);
  s.optional("checkpoint_every", &Output::checkpoint_every, unit::time,
             "smallest wall time between checkpoints; it is longer where they would take more than "
             "2 % of a run")
      .at_least(0);
  return s;
}

namespace {}  // namespace

}  // namespace sphgeo
