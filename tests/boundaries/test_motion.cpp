#include "deck/motion.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "boundaries/boundary.h"
#include "core/error.h"
#include "deck/model.h"
#include "output/temporary_folder.h"

using namespace sphgeo;

namespace {

Motion motion(const std::string& text, int dimension = 3, const std::string& folder = ".") {
  const Model m = read_deck_text(
      "dimension: " + std::to_string(dimension) +
          "\nresolution: 0.1\nend_time: 1\nmaterials: [{name: water, type: water}]\nboundaries:\n"
          "  - {name: gate, type: wall, shape: {type: box, min: [0, 0, 0], max: [1, 1, 1]}, "
          "motion: " +
          text + "}\n",
      {}, "deck", folder);
  return *dynamic_cast<const WallBoundary&>(*m.boundaries[0]).motion;
}

bool near(const Vec3& a, const Vec3& b, double tolerance) {
  const bool is = (a - b).norm() < tolerance;
  if (!is) {
    INFO("(", a.x(), ", ", a.y(), ", ", a.z(), ") is not (", b.x(), ", ", b.y(), ", ", b.z(), ")");
    CHECK(is);
  }
  return is;
}

// A table on disk for the time of one test.
struct Table {
  test::TemporaryFolder folder;
  explicit Table(const std::string& text) { std::ofstream(folder / "gate.csv") << text; }
  Motion motion(const std::string& more = "") const {
    return ::motion("{table: gate.csv" + more + "}", 3, folder.path());
  }
};

}  // namespace

TEST_SUITE("boundaries") {
  TEST_CASE("a formula moves every point alike; velocity and acceleration are its derivatives") {
    const Motion m = motion("{displacement: [0.1*sin(6*t), t^2, -0.5*t]}");
    for (const double t : {0.01, 0.3, 0.77, 2.0}) {
      const Vec3 from(1, 2, 3);
      CHECK(near(m.position(from, t), from + Vec3(0.1 * std::sin(6 * t), t * t, -0.5 * t), 1e-14));
      CHECK(near(m.velocity(from, t), {0.6 * std::cos(6 * t), 2 * t, -0.5}, 1e-7));
      CHECK(near(m.acceleration(from, t), {-3.6 * std::sin(6 * t), 2, 0}, 1e-5));
      CHECK(near(m.direction({0, 0, 1}, t), {0, 0, 1}, 1e-15));
    }
  }

  TEST_CASE("a rotation turns about its axis through its centre") {
    // About +y by the right hand: z goes to x.
    const Motion m = motion("{angle: 2*t, axis: [0, 3, 0], center: [1, 0, 0]}");
    const Vec3 from(1, 5, 2);
    for (const double t : {0.1, 0.6, 1.4}) {
      const double a = 2 * t;
      CHECK(near(m.position(from, t), {1 + 2 * std::sin(a), 5, 2 * std::cos(a)}, 1e-14));
      CHECK(near(m.velocity(from, t), {4 * std::cos(a), 0, -4 * std::sin(a)}, 1e-6));
      CHECK(near(m.acceleration(from, t), {-8 * std::sin(a), 0, -8 * std::cos(a)}, 1e-5));
      CHECK(near(m.direction({0, 0, 1}, t), {std::sin(a), 0, std::cos(a)}, 1e-14));
    }
    // Angles may come in degrees, and the default axis turns the x-z plane.
    const Motion degrees = motion("{angle: 30 deg}", 2);
    CHECK(near(degrees.position({1, 0, 0}, 0.5), {std::cos(0.5235987755982988), 0, -0.5}, 1e-12));
  }

  TEST_CASE("rotation and displacement add up") {
    const Motion m = motion("{angle: t, center: [0, 0, 1], displacement: [0, 0, 3*t]}");
    const double t = 0.8;
    CHECK(near(m.position({2, 0, 1}, t), {2 * std::cos(t), 0, 1 - 2 * std::sin(t) + 3 * t}, 1e-14));
    CHECK(near(m.velocity({2, 0, 1}, t), {-2 * std::sin(t), 0, -2 * std::cos(t) + 3}, 1e-6));
    CHECK(m.max_speed({2, 0, 1}, 1.0) ==
          doctest::Approx(std::sqrt(4 + 9 - 12 * std::cos(1.0))).epsilon(0.01));
  }

  TEST_CASE("a table is met at its rows, and runs smoothly between them") {
    const Table linear("t,x,z\n0,0,1\n0.5,1,1\n2,4,1\n");
    const Motion m = linear.motion();
    CHECK(near(m.position(Vec3::Zero(), 0.5), {1, 0, 1}, 1e-14));
    CHECK(near(m.position(Vec3::Zero(), 1.1), {2.2, 0, 1}, 1e-13));
    CHECK(near(m.velocity(Vec3::Zero(), 0.5), {2, 0, 0}, 1e-9));
    CHECK(near(m.acceleration(Vec3::Zero(), 1.3), Vec3::Zero(), 1e-6));
    // Before and after the table the boundary rests.
    CHECK(near(m.position(Vec3::Zero(), 7), {4, 0, 1}, 1e-14));
    CHECK(near(m.velocity(Vec3::Zero(), 7), Vec3::Zero(), 1e-14));
    // A parabola is met to the accuracy of the rows.
    std::string rows = "t,angle\n";
    for (int k = 0; k <= 20; ++k)
      rows += std::to_string(0.1 * k) + "," + std::to_string(0.01 * k * k) + "\n";
    const Motion turning = Table(rows).motion(", displacement: [t, 0, 0]");
    const double a = 0.77 * 0.77;
    CHECK(near(turning.position({1, 0, 0}, 0.77), {std::cos(a) + 0.77, 0, -std::sin(a)}, 1e-5));
    CHECK(near(turning.velocity({0, 0, 0}, 0.77), {1, 0, 0}, 1e-6));
    CHECK(turning.velocity({1, 0, 0}, 0.77).z() ==
          doctest::Approx(-1.54 * std::cos(a)).epsilon(1e-3));
  }

  TEST_CASE("tables whose times do not rise, or that are not there, are refused") {
    CHECK_THROWS_AS(Table("t,x\n0,0\n0,1\n").motion(), DeckError);
    CHECK_THROWS_AS(Table("t,x\n0,0\n").motion(), DeckError);
    CHECK_THROWS_AS(Table("when,x\n0,0\n1,1\n").motion(), DeckError);
    CHECK_THROWS_AS(Table("t,X\n0,0\n1,1\n").motion(), DeckError);  // an unknown column
    CHECK_THROWS_AS(Table("t,roll\n0,0\n1,1\n").motion(), DeckError);
    CHECK_THROWS_AS(Table("t,x\n0,0\n1,\n2,1\n").motion(), DeckError);  // an empty cell
    CHECK_THROWS_AS(Table("t,x\n0,0\n1,1e300\n").motion(), DeckError);
    CHECK_THROWS_AS(Table("t,time,x\n0,0,0\n1,1,1\n").motion(), DeckError);
    CHECK_THROWS_AS(Table("t\n0\n1\n").motion(), DeckError);            // nothing moves
    CHECK_THROWS_AS(Table("t,x [s]\n0,0\n1,1\n").motion(), DeckError);  // not a length
    CHECK_THROWS_AS(motion("{table: no_such_file.csv}"), DeckError);
    CHECK_THROWS_AS(motion("{angle: t, axis: [0, 0, 0]}"), DeckError);
    CHECK_THROWS_AS(motion("{displacement: [t, 0, 0], from: 2, until: 1}"), DeckError);
  }

  TEST_CASE("a table is read in its units, with the separators of its program") {
    for (const char* text : {"t [ms],x [mm],angle [deg]\n0,0,0\n500,250,90\n1000,500,180\n",
                             "time [s];x [m];angle [rad]\n0;0;0\n0,5;0,25;1,5707963267948966\n"
                             "1;0,5;3,141592653589793\n",
                             "t x [cm] angle [deg]\n0 0 0\n0.5 25 90\n1 50 180\n"}) {
      CAPTURE(text);
      const Motion m = Table(text).motion();
      CHECK(near(m.position({1, 0, 0}, 0.5), {0.25, 0, -1}, 1e-12));
      CHECK(near(m.position({1, 0, 0}, 1), {-0.5, 0, 0}, 1e-12));
    }
  }

  TEST_CASE("a table that begins late needs a motion that begins no earlier") {
    const Table late("t,x\n1,0.5\n2,1.5\n");
    CHECK_THROWS_AS(late.motion(), DeckError);
    const Motion m = late.motion(", from: 1");
    CHECK(near(m.position(Vec3::Zero(), 1.5), {1, 0, 0}, 1e-12));
    const Table early("t,x\n-1,-1\n1,1\n");
    CHECK(near(early.motion().position(Vec3::Zero(), 0), Vec3::Zero(), 1e-12));
  }

  TEST_CASE("a table that moves a 2D scene along y is refused") {
    const Table t("t,x,y\n0,0,0\n1,1,1\n"), still("t,x,y\n0,0,0\n1,1,0\n");
    CHECK_NOTHROW(::motion("{table: gate.csv}", 2, still.folder.path()));
    CHECK_THROWS_AS(::motion("{table: gate.csv}", 2, t.folder.path()), DeckError);
  }

  TEST_CASE("a boundary rests before and after its motion") {
    const Motion m = motion("{displacement: [2*(t - 0.5), 0, 0], from: 0.5 s, until: 1.5 s}");
    const Vec3 x(1, 1, 1);
    CHECK(near(m.position(x, 0.2), x, 1e-14));
    CHECK(near(m.position(x, 1), x + Vec3(1, 0, 0), 1e-14));
    CHECK(near(m.position(x, 9), x + Vec3(2, 0, 0), 1e-14));
    CHECK(near(m.velocity(x, 1), {2, 0, 0}, 1e-9));
    for (const double t : {0.1, 0.5, 1.5, 3.0}) {
      CHECK(m.velocity(x, t) == Vec3::Zero());
      CHECK(m.acceleration(x, t) == Vec3::Zero());
    }
    CHECK(m.max_speed(x, 3) == doctest::Approx(2));
    CHECK(m.max_speed(x, 0.4) == 0.0);
  }
}
