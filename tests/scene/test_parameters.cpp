#include <doctest/doctest.h>

#include <cmath>

#include "deck/motion.h"
#include "scene/build.h"
#include "scene/parameters.h"

using namespace sphgeo;

namespace {

const char* const deck_of_all_phases =
    "dimension: 2\nresolution: 0.1\nend_time: 1\n"
    "materials:\n"
    "  - {name: water, type: water, density: 1020, viscosity: 2e-3, sound_speed: 25}\n"
    "  - {name: sand, type: soil, density: 2650, volume_fraction: 0.6, youngs_modulus: 1 MPa, "
    "poisson_ratio: 0.25, friction_angle: 30 deg, hydraulic_conductivity: 1e-3}\n"
    "  - {name: bedrock, type: soil, density: 2700, volume_fraction: 0.5, youngs_modulus: 2 MPa, "
    "friction_angle: 30 deg, skeleton: fixed, drag: none}\n"
    "  - {name: rubber, type: elastic, density: 1100, youngs_modulus: 3 MPa, poisson_ratio: 0.4}\n"
    "  - {name: rock, type: rigid, density: 2600, stiffness: 5 MPa}\n"
    "bodies:\n"
    "  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [1, 1, 1]}}\n"
    "  - {name: bed, material: sand, shape: {type: box, min: [1, 0, 0], max: [2, 1, 1]}}\n"
    "  - {name: base, material: bedrock, shape: {type: box, min: [2, 0, 0], max: [3, 1, 1]}}\n"
    "  - {name: plate, material: rubber, shape: {type: box, min: [4, 0, 0], max: [4.4, 1, 1]}, "
    "clamped: [{shape: {type: box, min: [4, 0, 0], max: [4.4, 1, 0.2]}}]}\n"
    "  - {name: block, material: rock, spacing: 0.05, shape: {type: box, min: [5, 0, 0], max: "
    "[5.4, 1, 0.4]}}\n"
    "boundaries:\n"
    "  - {name: floor, type: wall, shape: {type: box, min: [0, 0, -1], max: [6, 1, 0]}}\n"
    "  - {name: paddle, type: wall, shape: {type: box, min: [-1, 0, 0], max: [0, 1, 1]}, motion: "
    "{displacement: ['0.1*t', 0, 0]}}\n"
    "  - {name: jet, type: inlet, min: [3.2, 0, 2], max: [3.6, 1, 2], velocity: [0, 0, -1]}\n"
    "  - {name: drain, type: outlet, shape: {type: box, min: [7, 0, 0], max: [8, 1, 1]}}\n"
    "probes:\n"
    "  - {name: p, type: pressure, at: [0.5, 0.5, 0.5], every: 1 ms}\n"
    "numerics: {solid_gradient: quadratic, outside: stop, transport_at_surface: tangential, "
    "pair_precision: double}\n";

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE("the table holds what the deck says") {
    const Model model = read_deck_text(deck_of_all_phases);
    Diagnostics found;
    const Scene<2> scene = build_scene<2>(model, found);
    CAPTURE(found.render());
    REQUIRE_FALSE(found.has_errors());
    const Parameters& p = scene.world->parameters();

    CHECK(p.numerics.pair_precision == PairPrecision::full);
    CHECK(p.numerics.solid_gradient == SolidGradient::quadratic);
    CHECK(p.numerics.outside == OutsideDomain::stop);
    CHECK(p.numerics.transport_at_surface == SurfaceTransport::tangential);
    CHECK(p.numerics.density_reinitialization == DensityReinitialization::summation);
    CHECK(p.body_force == nullptr);
    CHECK(p.shortest_interval == doctest::Approx(1e-3));

    CHECK(p.water.density == 1020);
    CHECK(p.water.viscosity == 2e-3);
    CHECK(p.water.sound_speed == 25);
    CHECK(p.water.follows_porosity);

    REQUIRE(p.soil.of.size() == 5);
    CHECK_FALSE(p.soil.of[0].is_soil);
    const SoilPart &sand = p.soil.of[1], &base = p.soil.of[2];
    CHECK(sand.density == doctest::Approx(0.6 * 2650));
    CHECK(sand.sound_speed == doctest::Approx(std::sqrt(1e6 / 1.5 / (0.6 * 2650))));
    CHECK(sand.moves);
    CHECK(sand.drag == DragLaw::darcy);
    CHECK(sand.hydraulic_conductivity == 1e-3);
    CHECK(base.fixed);
    CHECK(base.drag == DragLaw::none);
    CHECK_FALSE(p.soil.uniform);
    CHECK(p.soil.deformable);
    CHECK(p.soil.fastest == sand.sound_speed);
    CHECK(p.soil.limiter == 40);  // 20 times the dimension

    const SolidPart &plate = p.solids.of[3], &block = p.solids.of[4];
    CHECK_FALSE(p.solids.of[1].is_solid);
    CHECK(plate.elastic);
    CHECK_FALSE(plate.rigid());
    CHECK(plate.set == "solids");
    CHECK(plate.shear == doctest::Approx(3e6 / 2.8));
    REQUIRE(plate.clamped.size() == 1);
    CHECK(plate.clamped[0].motion == nullptr);
    CHECK(block.rigid());
    CHECK(block.set == "solids_2");
    CHECK(block.contact_stiffness == 5e6);

    REQUIRE(p.boundary_motions.size() == 4);
    CHECK(p.boundary_motions[0].motion == nullptr);
    REQUIRE(p.boundary_motions[1].motion != nullptr);
    CHECK(p.boundary_motions[1].motion->position(Vec3::Zero(), 2).x() == doctest::Approx(0.2));
    REQUIRE(p.inlets.size() == 1);
    CHECK(p.inlets[0].layer.size() == 4);
    CHECK(p.inlets[0].across == 2);
    CHECK(p.inlets[0].direction == -1);
    REQUIRE(p.outlets.size() == 1);
    CHECK(p.outlets[0].name == "drain");
    CHECK(p.bodies[3].name == "plate");
    CHECK(p.boundaries[1].location == "deck:18:5");
  }

  TEST_CASE("soil that all rests, or is led, is told apart from soil that moves by forces") {
    Model model = read_deck_text(deck_of_all_phases);
    const std::vector<double> densities(model.bodies.size(), 1600.0);
    model.bodies[1].material = "bedrock";
    const SoilParameters rests = compile_soil(model, densities);
    CHECK_FALSE(rests.deformable);
    CHECK_FALSE(rests.any_moves);
    CHECK(rests.uniform);
    CHECK(rests.fastest == 0);
    CHECK(rests.first.is_soil);
  }
}
