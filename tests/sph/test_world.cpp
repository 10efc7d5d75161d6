#include <doctest/doctest.h>

#include <memory>

#include "core/error.h"
#include "sph/world.h"
#include "support/memory_state.h"

using namespace sphgeo;
using test::MemoryState;

namespace {

std::shared_ptr<const Parameters> table(OutsideDomain outside = OutsideDomain::remove) {
  auto p = std::make_shared<Parameters>();
  p->numerics.outside = outside;
  return p;
}

// Four particles in a row, 0.1 m apart.
ParticleSet<2>& add_row(World<2>& world) {
  ParticleSet<2>& set = world.add_set("water", "water", 0.1, 0.13, true);
  set.resize(4);
  for (Index i = 0; i < 4; ++i) {
    set.ids()[i] = static_cast<Id>(i);
    set.vector(fields::position)[i] = {0.1 * static_cast<double>(i), 0};
  }
  world.set_domain(Vec<2>::Constant(-1), Vec<2>::Constant(1));
  return set;
}

}  // namespace

TEST_SUITE("sph") {
  TEST_CASE("what leaves the domain is removed and counted, and its id is not given again") {
    World<2> world(table());
    ParticleSet<2>& set = add_row(world);
    set.vector(fields::position)[3] = {5, 0};
    world.rearrange();
    CHECK(set.size() == 3);
    CHECK(world.lost().at("water") == 1);
    CHECK(set.append(2) == 3);
    CHECK(set.ids()[3] == 4);
    CHECK(set.ids()[4] == 5);
  }

  TEST_CASE("a domain that nothing may leave stops the run") {
    World<2> world(table(OutsideDomain::stop));
    add_row(world).vector(fields::position)[3] = {5, 0};
    CHECK_THROWS_AS(world.rearrange(), UnstableError);
  }

  TEST_CASE("every part of a world gives back what it has saved") {
    MemoryState state;
    World<2> before(table());
    add_row(before);
    before.clock.time = 0.5;
    before.clock.acoustic_steps = 7;
    before.exchanged("drain").add(-1, 2.0, Vec<2>(1, 0), Vec<2>(0, 3), Vec<2>(0, -10));
    before.piston("paddle") = {0.1, 0.2, 0.3, 0.4};
    before.rearrange();
    before.set("water").append(1);
    before.save(state);

    World<2> after(table());
    after.add_set("water", "water", 0.1, 0.13, true);
    after.exchanged("drain");
    after.piston("paddle");
    after.load(state);
    CHECK(after.clock.time == 0.5);
    CHECK(after.clock.acoustic_steps == 7);
    CHECK(after.set("water").size() == 5);
    CHECK(after.set("water").append(1) == 5);
    CHECK(after.set("water").ids()[5] == 5);
    CHECK(after.domain_hi() == Vec<2>::Constant(1));
    CHECK(after.exchanged("drain").mass == -2);
    CHECK(after.exchanged("drain").momentum == Vec<2>(0, -6));
    CHECK(after.piston("paddle").lag == 0.2);
    CHECK(after.piston("paddle").shift == 0.4);
  }

  TEST_CASE("a state without something that the deck has is refused by name") {
    MemoryState state;
    World<2> before(table());
    add_row(before);
    before.save(state);
    World<2> after(table());
    add_row(after);
    after.piston("paddle");
    CHECK_THROWS_WITH_AS(after.load(state), doctest::Contains("pistons/paddle"), IoError);
  }
}
