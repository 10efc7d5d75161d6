// Particles that enter and leave: inlets, reservoirs, outlets.

#include <doctest/doctest.h>

#include <set>
#include <string>

#include "support/memory_state.h"
#include "support/rig.h"

using namespace sphgeo;
using test::Rig;

namespace {

std::string scene(const std::string& rest, int dimension = 2) {
  return "dimension: " + std::to_string(dimension) +
         "\nresolution: 0.05\nend_time: 1\ngravity: [0, 0, 0]\n"
         "numerics: {domain_min: [-20, -20, -20], domain_max: [20, 20, 20]}\nmaterials: [{name: "
         "water, type: water, sound_speed: 20}]\n" +
         rest;
}
const std::string water_block =
    "bodies: [{name: block, material: water, shape: {type: box, min: [0, 0, 0], max: [0.5, 0.2, "
    "0.3]}}]\n";

template <int Dim>
void run(Rig<Dim>& rig, double end) {
  rig.plan_it({});
  rig.stepper->run(end, {[] { return true; }});
}

}  // namespace

TEST_SUITE("effects") {
  TEST_CASE_TEMPLATE(
      "what enters through an inlet is its area times the way of the water, also when its speed "
      "changes",
      D, std::integral_constant<int, 2>, std::integral_constant<int, 3>) {
    constexpr int Dim = D::value;
    for (const char* speed : {"-1", "'-(0.1 + 2*t)'", "'-(1 + sin(20*t)/2)'"}) {
      CAPTURE(speed);
      Rig<Dim> rig(scene(std::string("boundaries: [{name: cloud, type: inlet, min: [0, 0, 1], max: "
                                     "[0.5, 0.2, 1], velocity: [0.1, 0, ") +
                             speed + "]}]\n",
                         Dim));
      run(rig, 1);
      const double now = rig.world.clock.time, way = std::string(speed) == "-1" ? now
                                                     : std::string(speed) == "'-(0.1 + 2*t)'"
                                                         ? 0.1 * now + now * now
                                                         : now + (1 - std::cos(20 * now)) / 40;
      const double row = Dim == 2 ? 10 : 40;
      const auto& book = rig.world.exchanged("cloud");
      CHECK(std::abs(book.entered - row * way / 0.05) <= row);
      CHECK(static_cast<double>(rig.water().size()) == book.entered);
      CHECK(book.mass == doctest::Approx(book.entered * 1000 * std::pow(0.05, Dim)));
      std::set<Id> ids;
      for (Index i = 0; i < rig.water().size(); ++i) ids.insert(rig.water().ids()[i]);
      CHECK(static_cast<Index>(ids.size()) == rig.water().size());
    }
  }

  TEST_CASE("an inlet is open between its times, and rains in drops when its share is below one") {
    Rig<2> timed(
        scene("boundaries: [{name: jet, type: inlet, min: [0, 0, 1], max: [0.5, 0, 1], velocity: "
              "[0, 0, -1], from: 0.2, until: 0.6}]\n"));
    run(timed, 1);
    CHECK(std::abs(timed.world.exchanged("jet").entered - 10 * 0.4 / 0.05) <= 10);
    Rig<2> drops(
        scene("boundaries: [{name: rain, type: inlet, min: [0, 0, 1], max: [5, 0, 1], velocity: "
              "[0, 0, -1], share: 0.2}]\n"));
    run(drops, 1);
    CHECK(drops.world.exchanged("rain").entered == doctest::Approx(0.2 * 100 * 20).epsilon(0.15));
  }

  TEST_CASE(
      "an outlet takes out what comes into it, of the sets that it names, and keeps the book") {
    Rig<2> rig(scene(water_block +
                     "boundaries: [{name: drain, type: outlet, shape: {type: box, min: "
                     "[0.25, -1, -1], max: [2, 1, 1]}}]\n"));
    run(rig, 0);
    CHECK(rig.water().size() == 30);
    const auto& book = rig.world.exchanged("drain");
    CHECK(book.left == 30);
    CHECK(book.mass == doctest::Approx(-30 * 2.5));
    Rig<2> other(scene(water_block +
                       "boundaries: [{name: drain, type: outlet, sets: [soil], shape: "
                       "{type: box, min: [0.25, -1, -1], max: [2, 1, 1]}}]\n"));
    run(other, 0);
    CHECK(other.water().size() == 60);
  }

  TEST_CASE(
      "a reservoir adds nothing to water that stands at its level, and a layer where it stands "
      "lower") {
    const std::string shape = "shape: {type: box, min: [0, 0, 0], max: [0.5, 0.2, 0.5]}";
    Rig<2> full(scene(water_block + "boundaries: [{name: lake, type: reservoir, " + shape +
                      ", level: 0.3}]\n"));
    run(full, 0);
    CHECK(full.water().size() == 60);
    Rig<2> low(scene(water_block + "boundaries: [{name: lake, type: reservoir, " + shape +
                     ", level: 0.35}]\n"));
    run(low, 0);
    CHECK(low.water().size() == 70);
    CHECK(low.world.exchanged("lake").entered == 10);
  }

  TEST_CASE("an inlet that is taken up again goes on in the middle of a layer") {
    const std::string deck = scene(
        "boundaries: [{name: cloud, type: inlet, min: [0, 0, 1], max: [0.5, 0.2, 1], velocity: "
        "[0, 0, -0.7]}]\n");
    Rig<2> whole(deck), first(deck), second(deck);
    whole.plan_it();
    whole.advance(9);
    first.plan_it();
    first.advance(4);
    test::MemoryState state;
    first.world.save(state);
    first.plan->save(state);
    second.plan_it();
    second.world.load(state);
    second.plan->load(state);
    second.advance(5);
    CHECK(second.water().size() > 0);
    CHECK(second.checksum() == whole.checksum());
  }

  TEST_CASE("mistakes of inlets, reservoirs and outlets are found") {
    const auto wrong = [](const std::string& boundary) {
      try {
        read_deck_text(scene("boundaries: [" + boundary + "]\n"));
      } catch (const DeckError& e) {
        return e.diagnostics.items().size();
      }
      return std::size_t{0};
    };
    CHECK(wrong("{name: a, type: inlet, min: [0, 0, 0], max: [1, 0, 1], velocity: [0, 0, -1]}") ==
          1);
    CHECK(wrong("{name: a, type: inlet, min: [0, 0, 1], max: [1, 0, 1], velocity: [1, 0, 0]}") ==
          1);
    CHECK(wrong("{name: a, type: inlet, min: [0, 0, 1], max: [1, 0, 1], velocity: [0, 0, 1], from: "
                "2, until: 1}") == 1);
    CHECK(
        wrong(
            "{name: a, type: reservoir, shape: {type: half_space, point: [0, 0, 1]}, level: 1}") ==
        1);
    CHECK(wrong("{name: a, type: reservoir, shape: {type: box, min: [0, 0, 0], max: [1, 1, 1]}, "
                "level: 2}") == 1);
    CHECK(wrong("{name: a, type: outlet, shape: {type: box, min: [0, 0, 0], max: [1, 1, 1]}, sets: "
                "[air]}") == 1);
  }
}
