#include "solve/run_cost.h"

#include "support/rig.h"

using namespace sphgeo;
using namespace sphgeo::test;

namespace {

const std::string dam =
    "dimension: 2\nresolution: 0.02\ngravity: 9.81\nend_time: 0.2\n"
    "materials: [{name: water, type: water, viscosity: 0.001}]\n"
    "bodies: [{name: column, material: water, shape: {type: box, min: [0, 0, 0], max: [0.4, 0.1, "
    "0.6]}, pressure: hydrostatic}]\n"
    "boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [1, 0.1, 0.8], open: [top]}]\n";

template <int Dim>
std::uint64_t bits_of(const World<Dim>& world) {
  std::string all;
  for (const auto& set : world.sets())
    for (const FieldSpec* f : {&fields::position, &fields::velocity}) {
      const auto& v = set->vector(*f);
      all.append(reinterpret_cast<const char*>(v.data()),
                 static_cast<std::size_t>(v.size()) * sizeof(Vec<Dim>));
    }
  return fnv1a(all);
}

}  // namespace

TEST_SUITE("solve") {
  TEST_CASE("the number of steps is that of a run at this speed, and asking leaves no trace") {
    Rig<2> rig(dam);
    rig.plan_it();
    const std::uint64_t before = bits_of(rig.world);
    const double speed = typical_speed(rig.world, rig.scene.sound);
    CHECK(speed == doctest::Approx(0.5 * rig.scene.sound.max_speed));
    const StepCounts expected = expected_steps(rig.world, *rig.plan, speed, 0.2);
    CHECK(bits_of(rig.world) == before);
    rig.stepper->run(0.2, {[] { return true; }});
    CHECK(expected.advection ==
          doctest::Approx(static_cast<double>(rig.world.clock.advection_steps)).epsilon(0.1));
    CHECK(expected.acoustic ==
          doctest::Approx(static_cast<double>(rig.world.clock.acoustic_steps)).epsilon(0.1));
    // Faster particles, shorter steps; as many more as there is time.
    CHECK(expected_steps(rig.world, *rig.plan, 2 * speed, 0.2).advection > expected.advection);
    CHECK(expected_steps(rig.world, *rig.plan, speed, 0.4).acoustic ==
          doctest::Approx(2 * expected.acoustic).epsilon(0.01));
  }

  TEST_CASE("memory grows with the set that it belongs to") {
    Rig<2> coarse(dam), fine(dam, {"resolution=0.01"});
    coarse.plan_it();
    fine.plan_it();
    const auto shares = memory_shares(coarse.world, *coarse.plan);
    double now = 0, scratch = 0;
    for (const MemoryShare& s : shares) (s.what == "scratch" ? scratch : now) += s.bytes;
    CHECK(now == doctest::Approx(static_cast<double>(coarse.world.bytes())));
    CHECK(scratch == doctest::Approx(static_cast<double>(coarse.plan->bytes())));
    const ParticleCounts from = counts_of(coarse.world), to = counts_of(fine.world);
    CHECK(bytes_at(shares, from, from) == doctest::Approx(now + scratch));
    double finer = 0;
    for (const MemoryShare& s : memory_shares(fine.world, *fine.plan)) finer += s.bytes;
    CHECK(bytes_at(shares, from, to) == doctest::Approx(finer).epsilon(0.15));
  }

  TEST_CASE("steps are timed from outside") {
    Rig<2> rig(dam);
    rig.plan_it();
    StepTimer<2> timer(rig.world, *rig.plan, *rig.stepper);
    CHECK_FALSE(timer.cost().has_value());
    int left = 4;
    rig.stepper->run(1e9, {[&] {
                       timer.end();
                       timer.begin();
                       return left-- > 0;
                     }});
    CHECK(timer.steps() == 4);
    const auto cost = timer.cost();
    REQUIRE(cost.has_value());
    CHECK(cost->advection > 0);
    CHECK(cost->acoustic > 0);
    CHECK(cost->of({3, 20}) == doctest::Approx(3 * cost->advection + 20 * cost->acoustic));
    CHECK(cost->of({3, 18}) <= timer.seconds() * 1.01);
  }

  TEST_CASE("a calibration ends with its time or its steps") {
    Rig<2> rig(dam);
    rig.plan_it();
    REQUIRE(calibrate<2>(rig.world, *rig.plan, 60.0, 5).has_value());
    CHECK(rig.world.clock.advection_steps == 5);
    REQUIRE(calibrate<2>(rig.world, *rig.plan, 0.0, 1e9).has_value());
    CHECK(rig.world.clock.advection_steps == 8);
  }
}
