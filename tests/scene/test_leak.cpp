#include "scene/leak.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>

#include "scene/flood.h"
#include "support/rig.h"

using namespace sphgeo;

namespace {

// Findings about leaks only, "W125 boundaries[1]" or "N126 boundaries[0].open", and the last
// message.
struct Leaks {
  std::vector<std::string> found;
  std::string message;
};

// In 2D the walls across y are left out: they would fill the plane.
template <int Dim>
Leaks leaks(std::string rest) {
  for (const char* name : {"front", "back"})
    if (const auto at = rest.find(std::string("  - {name: ") + name);
        Dim == 2 && at != std::string::npos)
      rest.erase(at, rest.find('\n', at) + 1 - at);
  const std::string text =
      "dimension: " + std::to_string(Dim) +
      "\nresolution: 0.05\nend_time: 1\nmaterials: [{name: water, type: water, max_speed: 5}]\n" +
      rest;
  const Model model = read_deck_text(text);
  Diagnostics found;
  const Scene<Dim> scene = build_scene<Dim>(model, found);
  check_leaks(scene, found);
  Leaks l;
  for (const Diagnostic& d : found.items()) {
    l.found.push_back(d.id + " " + d.path);
    l.message = d.message;
    CHECK(d.place.line > 0);
  }
  return l;
}

bool silent(const std::string& rest) {
  return leaks<2>(rest).found.empty() && leaks<3>(rest).found.empty();
}

using Found = std::vector<std::string>;

std::string box(double x0, double z0, double x1, double z1, double y0 = 0, double y1 = 0.4) {
  return fmt::format("{{type: box, min: [{}, {}, {}], max: [{}, {}, {}]}}", x0, y0, z0, x1, y1, z1);
}
std::string wall(const std::string& name, const std::string& shape, const std::string& more = "") {
  return "  - {name: " + name + ", type: wall, shape: " + shape + more + "}\n";
}
// Water from x = 0 to `x`, up to `z`.
std::string leak_pool(double x, double z) {
  return "bodies: [{name: pool, material: water, shape: " + box(0, 0, x, z) + "}]\n";
}
std::string leak_tank(double x, double z, const std::string& open = "top") {
  return fmt::format(
      "boundaries:\n  - {{name: tank, type: tank, min: [0, 0, 0], max: [{}, 0.4, {}], open: "
      "[{}]}}\n",
      x, z, open);
}
// A trough from walls of its own, 1 m long inside, with its right wall from `gap` above the floor.
std::string trough(double gap, double height = 0.8) {
  return "boundaries:\n" + wall("floor", box(-0.2, -0.2, 1.2, 0, -0.2, 0.6)) +
         wall("left", box(-0.2, 0, 0, height, -0.2, 0.6)) +
         wall("right", box(1, gap, 1.2, height, -0.2, 0.6)) +
         wall("front", box(0, 0, 1, height, -0.2, 0)) +
         wall("back", box(0, 0, 1, height, 0.4, 0.6));
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE(
      "a flood finds gaps of one spacing wherever they lie on the grid, and none in a lattice") {
    const double dp = 0.1;
    for (const int missing : {0, 1, 2})
      for (const double off : {0.0, 0.013, 0.025, 0.04}) {
        CAPTURE(missing);
        CAPTURE(off);
        FloodFrame frame{3, dp, 2, true, {}};
        std::vector<Vec3> solids, liquid;
        for (int k = -2; k < 8; ++k)
          for (int j = -2; j < 8; ++j)
            for (int i = -2; i < 8; ++i) {
              const Vec3 at((i + 0.5) * dp + off, (j + 0.5) * dp + 2 * off, (k + 0.5) * dp - off);
              const bool inside = i >= 0 && i < 6 && j >= 0 && j < 6 && k >= 0;
              if (inside && k < 4) liquid.push_back(at);
              if (inside || (missing == 1 && i >= 6 && j == 3 && k == 1) ||
                  (missing == 2 && k < 0 && i == 2 && j == 2))
                continue;
              solids.push_back(at);
              frame.box.extend(at);
            }
        frame.box.hi.z() = 0.35 - off;
        FloodGrid grid(frame);
        for (const Vec3& p : solids) grid.add_solid(p);
        for (const Vec3& p : liquid) grid.add_liquid(p);
        const auto pools = grid.pools();
        REQUIRE(pools.size() == 1);
        const int top = grid.layers() - 2;
        CHECK(grid.escapes(pools[0], top) == (missing > 0));
        const auto spill = grid.spill_layer(pools[0], static_cast<Index>(8 * liquid.size()), top);
        CHECK(spill.has_value() == (missing > 0));
        const auto path = grid.widest_path(pools[0], top);
        CHECK(path.empty() == (missing == 0));
        bool through = false;
        const Vec3 hole = missing == 1 ? Vec3(0.65 + off, 0.35 + 2 * off, 0.15 - off)
                                       : Vec3(0.25 + off, 0.25 + 2 * off, -0.05 - off);
        for (const auto& step : path)
          through = through || (step.at - hole).cwiseAbs().maxCoeff() < 0.5 * dp;
        CHECK(through == (missing > 0));
      }
  }

  TEST_CASE("a liquid that finds room below its rim does not spill") {
    // A trough 10 cells wide and 10 high, filled with a column 3 wide and 15 high.
    FloodFrame frame{2, 0.2, 2, true, {}};
    std::vector<Vec3> solids;
    for (double z = 0.05; z < 1; z += 0.1)
      solids.insert(solids.end(), {Vec3(-0.1, 0, z), Vec3(1.1, 0, z)});
    for (double x = -0.1; x < 1.15; x += 0.1) solids.emplace_back(x, 0, -0.1);
    for (const Vec3& p : solids) frame.box.extend(p);
    frame.box.extend(Vec3(0.5, 0, 1.5));
    FloodGrid grid(frame);
    for (const Vec3& p : solids) grid.add_solid(p);
    for (double z = 0.1; z < 1.45; z += 0.2) grid.add_liquid({0.3, 0, z});
    const auto pools = grid.pools();
    REQUIRE(pools.size() == 1);
    const int top = grid.layers() - 2;
    CHECK(grid.escapes(pools[0], top));  // over the rim
    CHECK_FALSE(grid.spill_layer(pools[0], 40, top));
    CHECK(grid.spill_layer(pools[0], 400, top));
  }

  TEST_CASE("containers that hold are passed in silence") {
    CHECK(silent(leak_pool(0.5, 0.4) + leak_tank(1, 0.8)));
    CHECK(silent(leak_pool(0.5, 0.8) + leak_tank(0.5, 0.8)));  // full to the brim
    CHECK(silent(leak_pool(0.25, 0.8) +
                 leak_tank(2, 0.4)));  // a column higher than the tank: it settles
    CHECK(silent(leak_pool(1, 0.4) + trough(0)));
    CHECK(silent("gravity: 0\n" + leak_pool(1, 0.4) + trough(0.1)));  // no down
    CHECK(silent(leak_pool(0.5, 0.4)));                               // a drop
    CHECK(
        silent(leak_pool(0.5, 0.4) + "boundaries:\n" + wall("plate", box(-1, -0.2, 2, 0, -1, 1))));
    CHECK(silent(leak_pool(0.5, 0.4) + "boundaries:\n" + wall("plate", box(-1, -0.2, 2, 0, -1, 1)) +
                 wall("stop", box(0.5, 0, 0.7, 1, -1, 1))));
    // A gate that opens later, in a channel whose end is open.
    CHECK(silent(leak_pool(0.5, 0.4) + leak_tank(2, 0.8, "top, right") +
                 wall("gate", box(0.5, 0, 0.7, 0.8), ", motion: {displacement: [0, 0, 2*t]}")));
    // A gate that starts lifted, in a closed tank.
    CHECK(silent(leak_pool(0.5, 0.4) + leak_tank(2, 0.8) + wall("gate", box(0.5, 0.1, 0.7, 0.8))));
    // The upper of two vessels runs out into the lower one.
    CHECK(silent(
        leak_pool(1, 0.4) + trough(0.1) +
        "  - {name: basin, type: tank, min: [-1, -1, -1.5], max: [3, 1.4, -0.5], open: [top]}\n"));
  }

  TEST_CASE("a gap of one spacing is found with its place and the nearest boundary") {
    const Leaks flat = leaks<2>(leak_pool(1, 0.4) + trough(0.05)),
                deep = leaks<3>(leak_pool(1, 0.4) + trough(0.05));
    CHECK(flat.found.size() == 1);
    CHECK((flat.found == Found{"W125 boundaries[2]"} || flat.found == Found{"W125 boundaries[0]"}));
    CHECK(flat.message.find("body 'pool' can run out") == 0);
    CHECK(flat.message.find("x = 1.") != std::string::npos);
    CHECK(flat.message.find("z = 0.02") != std::string::npos);
    CHECK(flat.message.find("(1 spacings)") != std::string::npos);
    CHECK(deep.found.size() == 1);
    CHECK(deep.message.find("z = 0.02") != std::string::npos);
    // Far from the water, which gets there later.
    CHECK(leaks<2>(leak_pool(0.2, 0.4) + trough(0.05)).found.size() == 1);
    // Less than half a spacing lets nothing through.
    CHECK(silent(leak_pool(1, 0.4) + trough(0.02)));
  }

  TEST_CASE("a scene too wide for its spacing is not searched, and that is said") {
    // A leaking trough, and a second one far away and below.
    const auto far = [](double at) {
      return leak_pool(1, 0.4) + trough(0.05) +
             wall("far", fmt::format("{{type: box, min: [{}, 0, {}], max: [{}, 0.4, {}]}}", at, -at,
                                     at + 0.2, 0.2 - at));
    };
    const Leaks wide = leaks<2>(far(400));
    CHECK(wide.found == Found{"N127 resolution"});
    CHECK(wide.message.find("'water'") != std::string::npos);
    CHECK(wide.message.find("2.6e+08 cells") != std::string::npos);
    CHECK(leaks<2>(far(40)).found.size() == 1);
    CHECK(leaks<2>(far(40)).found[0].starts_with("W125"));
  }

  TEST_CASE("gaps in the floor, at half height and in an upright edge are found") {
    const auto floor = [](const std::string& right) {
      return "boundaries:\n" + wall("floor", box(-0.2, -0.2, 0.5, 0, -0.2, 0.6)) +
             wall("floor2", box(0.6, -0.2, 1.2, 0, -0.2, 0.6)) +
             wall("left", box(-0.2, 0, 0, 0.8, -0.2, 0.6)) + right +
             wall("front", box(0, 0, 1, 0.8, -0.2, 0)) + wall("back", box(0, 0, 1, 0.8, 0.4, 0.6));
    };
    const Leaks down =
        leaks<3>(leak_pool(1, 0.4) + floor(wall("right", box(1, 0, 1.2, 0.8, -0.2, 0.6))));
    CHECK(down.found.size() == 1);
    CHECK(down.message.find("x = 0.5") != std::string::npos);
    // The settled water stays below the hole, but the wave of the dam break reaches it and falls
    // out.
    const std::string holed =
        "boundaries:\n" + wall("floor", box(-0.2, -0.2, 1, 0, -0.2, 0.6)) +
        wall("left", box(-0.2, 0, 0, 0.8, -0.2, 0.6)) + wall("front", box(0, 0, 1, 0.8, -0.2, 0)) +
        wall("back", box(0, 0, 1, 0.8, 0.4, 0.6)) + wall("low", box(1, -0.2, 1.2, 0.3, -0.2, 0.6)) +
        wall("high", box(1, 0.4, 1.2, 0.8, -0.2, 0.6));
    CHECK(leaks<2>(leak_pool(0.25, 0.8) + holed).found.size() == 1);
    CHECK(leaks<2>(leak_pool(0.25, 0.8) + holed).message.find("z = 0.35") != std::string::npos);
    CHECK(leaks<2>(leak_pool(0.25, 0.3) + holed).found.empty());
    // Front wall and right wall do not meet: a slit from floor to rim.
    std::string slit = trough(0);
    slit.replace(slit.find(box(0, 0, 1, 0.8, -0.2, 0)), box(0, 0, 1, 0.8, -0.2, 0).size(),
                 box(0, 0, 0.9, 0.8, -0.2, 0));
    CHECK(leaks<3>(leak_pool(1, 0.4) + slit).found.size() == 1);
    CHECK(leaks<2>(leak_pool(1, 0.4) + slit).found.empty());
  }

  TEST_CASE(
      "water above a rim all around is found, a low wall on one side is not taken for a mistake") {
    CHECK(leaks<2>(leak_pool(1, 0.8) + trough(0, 0.75)).found.size() == 1);
    CHECK(silent(leak_pool(1, 0.8) + trough(0, 0.4)));
  }

  TEST_CASE("an open face is a note, and only when the water starts there") {
    const Leaks at = leaks<2>(leak_pool(1, 0.4) + leak_tank(1, 0.8, "top, right"));
    CHECK(at.found == Found{"N126 boundaries[0].open"});
    CHECK(at.message.find("'right'") != std::string::npos);
    CHECK(leaks<3>(leak_pool(1, 0.4) + leak_tank(1, 0.8, "front")).found ==
          Found{"N126 boundaries[0].open"});
    CHECK(silent(leak_pool(0.5, 0.4) + leak_tank(1, 0.8, "top, right")));
    // The face opens into another boundary that holds the water.
    CHECK(
        leaks<2>(
            leak_pool(1, 0.4) + leak_tank(1, 0.8, "top, right") +
            "  - {name: next, type: tank, min: [1, 0, 0], max: [2, 0.4, 0.8], open: [top, left]}\n")
            .found.empty());
  }

  TEST_CASE("an open face that another wall closes is not the one through which water runs out") {
    // Both tanks have a bottom between them, the first one none; the right side is open.
    const Leaks l = leaks<2>(
        "bodies: [{name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [1, 0.2, "
        "0.3]}}]\nboundaries:\n"
        "  - {name: sides, type: tank, min: [0, 0, 0], max: [1, 0.2, 0.5], open: [bottom, right, "
        "top]}\n"
        "  - {name: floor, type: tank, min: [0, 0, 0], max: [1, 0.2, 0.5], open: [left, right, "
        "top]}\n");
    REQUIRE(l.found.size() == 1);
    CHECK(l.message.find("'right'") != std::string::npos);
  }
}
