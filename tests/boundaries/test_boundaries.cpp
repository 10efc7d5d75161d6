#include "boundaries/boundary.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/error.h"
#include "deck/model.h"

using namespace sphgeo;

namespace {

Model deck(int dimension, const std::string& boundary) {
  return read_deck_text(
      "dimension: " + std::to_string(dimension) +
      "\nresolution: 0.1\nend_time: 1\nmaterials: [{name: water, type: water}]\nboundaries:\n  - " +
      boundary + "\n");
}

const WallBoundary& wall_of(const Model& model) {
  return dynamic_cast<const WallBoundary&>(*model.boundaries[0]);
}

constexpr double dp = 0.1;
Placement placement(int dimension) { return {dp, 0.36, dimension, {}}; }

bool near(const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-12; }

// The wall point at a place; fails when there is none.
WallPoint at(const std::vector<WallPoint>& points, const Vec3& place) {
  for (const WallPoint& p : points)
    if ((p.position - place).norm() < 1e-9) return p;
  FAIL_CHECK("no wall particle at (", place.x(), ", ", place.y(), ", ", place.z(), ")");
  return {};
}

}  // namespace

TEST_SUITE("boundaries") {
  TEST_CASE("the particles of a tank stand on its faces whatever its size") {
    // 0.47 and 0.33 are no multiples of 0.1; the floor is at -0.02.
    const Model m =
        deck(2, "{name: tank, type: tank, min: [0.01, 0, -0.02], max: [0.48, 1, 0.31]}");
    const auto points = wall_of(m).points(placement(2));
    const Vec3 lo(0.01, 0, -0.02), hi(0.48, 0, 0.31);
    double left = -1e9, right = 1e9, floor = -1e9, lid = 1e9;
    for (const WallPoint& p : points) {
      CHECK(p.position.y() == 0.0);
      CHECK(p.normal.norm() == doctest::Approx(1));
      CHECK(p.normal.y() == 0.0);
      const bool inside_x = p.position.x() > lo.x() && p.position.x() < hi.x();
      const bool inside_z = p.position.z() > lo.z() && p.position.z() < hi.z();
      CHECK_FALSE((inside_x && inside_z));
      if (inside_z && p.position.x() < lo.x()) left = std::max(left, p.position.x());
      if (inside_z && p.position.x() > hi.x()) right = std::min(right, p.position.x());
      if (inside_x && p.position.z() < lo.z()) floor = std::max(floor, p.position.z());
      if (inside_x && p.position.z() > hi.z()) lid = std::min(lid, p.position.z());
      // On a face the normal points inwards, in a corner to the corner.
      if (inside_z) CHECK(near(p.normal, {p.position.x() < lo.x() ? 1.0 : -1.0, 0, 0}));
      else if (inside_x) CHECK(near(p.normal, {0, 0, p.position.z() < lo.z() ? 1.0 : -1.0}));
      else CHECK(near(p.normal, (p.position.cwiseMax(lo).cwiseMin(hi) - p.position).normalized()));
    }
    CHECK(left == doctest::Approx(lo.x() - 0.05));
    CHECK(right == doctest::Approx(hi.x() + 0.05));
    CHECK(floor == doctest::Approx(lo.z() - 0.05));
    CHECK(lid == doctest::Approx(hi.z() + 0.05));
    // The inside is divided evenly: 5 by 3 cells, and 4 layers of wall all around.
    CHECK(points.size() == 13 * 11 - 5 * 3);
    at(points, {0.01 + 0.5 * 0.094, 0, -0.07});
    at(points, {0.01 - 0.35, 0, -0.02 - 0.35});
  }

  TEST_CASE("open faces have no wall, neither beside nor above them") {
    const Model m =
        deck(2, "{name: tank, type: tank, min: [0, 0, 0], max: [0.5, 1, 0.3], open: [top, right]}");
    const auto points = wall_of(m).points(placement(2));
    for (const WallPoint& p : points) {
      CHECK(p.position.z() < 0.3);
      CHECK(p.position.x() < 0.5);
    }
    CHECK(points.size() == 9 * 7 - 5 * 3);
  }

  TEST_CASE("a tank in 3D has four layers on every closed face") {
    const Model m = deck(
        3, "{name: tank, type: tank, min: [0, 0, 0], max: [0.5, 0.4, 0.3], open: [top, front]}");
    const auto points = wall_of(m).points(placement(3));
    CHECK(points.size() == 13 * 8 * 7 - 5 * 4 * 3);
    CHECK(near(at(points, {0.25, 0.45, 0.15}).normal, {0, -1, 0}));
    CHECK(near(at(points, {0.25, 0.25, -0.15}).normal, {0, 0, 1}));
    // Nearer to an open face than to the inside: the rim, which faces what may land on it.
    CHECK(near(at(points, {0.25, 0.25, -0.35}).normal, {0, -1, 0}));
    CHECK(near(at(points, {-0.35, 0.35, 0.25}).normal, {0, 0, 1}));
    CHECK(near(at(points, {-0.05, 0.25, 0.05}).normal, {1, 0, 0}));
    CHECK(near(at(points, {-0.05, 0.45, -0.05}).normal, Vec3(1, -1, 1).normalized()));
    for (const WallPoint& p : points) CHECK(p.position.y() > 0);
  }

  TEST_CASE("the solid of a tank holds its particles and nothing of the inside") {
    for (const int dimension : {2, 3}) {
      const Model m = deck(
          dimension, "{name: tank, type: tank, min: [0, 0, 0], max: [0.5, 0.4, 0.3], open: [top]}");
      const auto solid = wall_of(m).solid(placement(dimension));
      REQUIRE(solid);
      for (const WallPoint& p : wall_of(m).points(placement(dimension)))
        CHECK(solid->signed_distance(p.position) < 0);
      const double y = dimension == 2 ? 0 : 0.2;
      CHECK(solid->signed_distance({0.25, y, 0.15}) > 0);
      CHECK(solid->signed_distance({0.25, y, 0.5}) > 0);
      CHECK(solid->signed_distance({-0.2, y, 0.15}) < 0);
    }
  }

  TEST_CASE("a wall of any shape is filled as deep as a kernel reaches, with normals outwards") {
    const Model m =
        deck(2, "{name: block, type: wall, shape: {type: box, min: [0, 0, 0], max: [2, 1, 1]}}");
    const auto points = wall_of(m).points(placement(2));
    // Cells 0.05, 0.15 ... deeper than 0.36 are left out: 12 by 2 of 20 by 10.
    CHECK(points.size() == 20 * 10 - 12 * 2);
    CHECK(near(at(points, {0.05, 0, 0.45}).normal, {-1, 0, 0}));
    CHECK(near(at(points, {1.95, 0, 0.55}).normal, {1, 0, 0}));
    CHECK(near(at(points, {1.05, 0, 0.95}).normal, {0, 0, 1}));
    CHECK(near(at(points, {1.05, 0, 0.25}).normal, {0, 0, -1}));
    const Model ball =
        deck(3, "{name: ball, type: wall, shape: {type: sphere, center: [0, 0, 0], radius: 0.5}}");
    const auto round = wall_of(ball).points(placement(3));
    CHECK(round.size() > 300);
    for (const WallPoint& p : round) {
      CHECK(p.position.norm() < 0.5);
      // A distance estimated from a level set is not smooth at its centre.
      if (p.position.norm() > 0.2) CHECK(p.normal.dot(p.position.normalized()) > 0.999);
    }
  }

  TEST_CASE("walls stick unless they are told to slip, and rest unless they are told to move") {
    const Model m =
        deck(2, "{name: block, type: wall, shape: {type: box, min: [0, 0, 0], max: [2, 1, 1]}}");
    CHECK(wall_of(m).slip_kind() == Slip::no_slip);
    CHECK_FALSE(wall_of(m).motion.has_value());
    const Model s = deck(2,
                         "{name: block, type: wall, slip: free_slip, shape: {type: box, min: [0, "
                         "0, 0], max: [2, 1, 1]}}");
    CHECK(wall_of(s).slip_kind() == Slip::free_slip);
  }

  TEST_CASE("a tank without extent is refused, its y is ignored in 2D") {
    CHECK_THROWS_AS(deck(2, "{name: tank, type: tank, min: [0, 0, 0], max: [0, 1, 0.3]}"),
                    DeckError);
    CHECK_THROWS_AS(deck(3, "{name: tank, type: tank, min: [0, 0, 0], max: [1, 0, 0.3]}"),
                    DeckError);
    CHECK_NOTHROW(deck(2, "{name: tank, type: tank, min: [0, 0, 0], max: [1, 0, 0.3]}"));
    CHECK_THROWS_AS(
        deck(2, "{name: tank, type: tank, min: [0, 0, 0], max: [1, 0, 0.3], open: [lid]}"),
        DeckError);
  }
}
