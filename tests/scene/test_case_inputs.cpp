// Files that other programs wrote and that were misread once, with what is right for each.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "boundaries/boundary.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "deck/model.h"
#include "deck/motion.h"
#include "scene/extent.h"
#include "scene/output_check.h"

using namespace sphgeo;

namespace {

const std::string case_folder = SPHGEO_SOURCE_DIR "/tests/scene/files";

Model case_deck(const std::string& folder, const std::string& deck,
                const std::vector<std::string>& set = {}) {
  const std::string within = case_folder + "/" + folder;
  return read_deck_text(read_file(within + "/" + deck), set, deck, within);
}

const WallBoundary& wall_of(const Model& model) {
  return dynamic_cast<const WallBoundary&>(*model.boundaries[0]);
}

Motion tank_motion(const std::string& table) {
  const Model m =
      case_deck("motion", "tank.yaml", {"boundaries[0].motion.table=" + table + ".csv"});
  return *wall_of(m).motion;
}

ShapePtr part_of(const Model& model) {
  return wall_of(model).solid({model.resolution, 2 * model.resolution, 3});
}

/// The first error of the deck, "" when it is sound.
std::string case_error(const std::string& folder, const std::string& deck,
                       const std::vector<std::string>& set) {
  try {
    case_deck(folder, deck, set);
  } catch (const DeckError& e) {
    return e.diagnostics.items().at(0).message;
  }
  return {};
}

bool holds(const std::string& text, const std::string& part) {
  CAPTURE(text);
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE("a shaken tank follows its table in x alone, whatever the units and separators") {
    for (const char* table : {"motion", "mm_header", "ms_header", "semicolon"}) {
      CAPTURE(table);
      const Motion m = tank_motion(table);
      for (const double t : {0.0, 0.2, 0.5, 1.3, 3.75}) {
        const Vec3 moved = m.position({0.6, 0, 0.5}, t) - Vec3(0.6, 0, 0.5);
        CHECK(std::abs(moved.x() - 0.02 * std::sin(std::numbers::pi * t)) < 5e-6);
        CHECK(moved.y() == 0);
        CHECK(moved.z() == 0);
      }
    }
    const Motion turned = tank_motion("angle_deg");
    const double angle = std::numbers::pi / 180 * 4;
    const Vec3 at = turned.position(Vec3::UnitX(), 0.5);
    CHECK(at.x() == doctest::Approx(std::cos(angle)).epsilon(1e-9));
    CHECK(std::abs(at.z()) == doctest::Approx(std::sin(angle)).epsilon(1e-9));
  }

  TEST_CASE("tables of motion that cannot be followed are errors with file and line") {
    const auto error = [](const char* table) {
      return case_error("motion", "tank.yaml",
                        {std::string("boundaries[0].motion.table=") + table + ".csv"});
    };
    CHECK(holds(error("wrong_name"),
                "wrong_name.csv:1: there is no column 'X' here; did you mean 'x'?"));
    CHECK(holds(error("roll_name"), "roll_name.csv:1: there is no column 'roll' here; columns: t"));
    CHECK(holds(error("gap"), "gap.csv:42: column 'x': the cell is empty"));
    CHECK(holds(error("starts_late"), "starts_late.csv:2: the table begins at t = 1 s"));
  }

  TEST_CASE("terrain is that of the map, in every form of file") {
    const auto surface = [](const std::vector<std::string>& set, const char* deck = "ok.yaml") {
      return part_of(case_deck("terrain", deck, set));
    };
    const ShapePtr grid = surface({}),
                   points = surface({"boundaries[0].shape.file=points_xyz.csv"}),
                   spaced = surface({}, "xyzcsv.yaml");
    for (const Vec3& node : {Vec3(0.4, 0.3, 0.23), Vec3(1.1, 0.2, 0.08), Vec3(0, 0.1, 0.32)})
      for (const ShapePtr& s : {grid, points, spaced})
        CHECK(std::abs(s->signed_distance(node)) < 1e-12);
    // Rows of an ESRI grid run from north to south.
    const std::string map = "boundaries[0].shape.file=grid.asc";
    const ShapePtr esri =
        surface({map, "boundaries[0].shape.map_origin=[556440.05, 5394932.05, 0]"});
    for (const Vec3& node : {Vec3(0.4, 0.5, 0.23), Vec3(1.1, 0.6, 0.08), Vec3(0, 0.7, 0.32)})
      CHECK(std::abs(esri->signed_distance(node)) < 1e-9);
    CHECK(
        holds(case_error("terrain", "ok.yaml", {map}), "`map_origin: [556440.05, 5394932.05, 0]`"));
  }

  TEST_CASE("a height that is not known is none") {
    const std::string file = "boundaries[0].shape.file=grid_nodata.csv";
    CHECK(holds(case_error("terrain", "ok.yaml", {file}),
                "1 of 108 heights are missing, the first at x = 0.4, y = 0.3 m"));
    const ShapePtr filled =
        part_of(case_deck("terrain", "ok.yaml", {file, "boundaries[0].shape.holes=fill"}));
    // The mean of the four around it.
    CHECK(std::abs(filled->signed_distance({0.4, 0.3, (0.24 + 0.22 + 0.24 + 0.22) / 4})) < 1e-6);
  }

  TEST_CASE("surfaces of other programs are read: capitals, a count of 0, lines that end in CR") {
    for (const char* file : {"g_upper", "g_count0", "g_cr_only"}) {
      CAPTURE(file);
      const ShapePtr cube = part_of(
          case_deck("stl", "one.yaml", {std::string("boundaries[0].shape.file=") + file + ".stl"}));
      CHECK((cube->box().lo).norm() < 1e-9);
      CHECK((cube->box().hi - Vec3::Constant(0.002)).norm() < 1e-9);
      CHECK(cube->signed_distance(Vec3::Constant(0.001)) == doctest::Approx(-0.001));
      CHECK(cube->signed_distance({0.001, 0.001, 0.003}) == doctest::Approx(0.001));
    }
  }

  TEST_CASE("a surface in coordinates of a map is too large, with its extent and its place") {
    const Model m = case_deck("stl", "one.yaml", {"boundaries[0].shape.file=g_utm_ascii.stl"});
    Diagnostics found;
    check_extent(m, found);
    REQUIRE(found.items().size() == 1);
    const Diagnostic& d = found.items()[0];
    CHECK(d.id == "E146");
    CHECK(d.place.line == 12);
    CHECK(holds(d.message, "the scene is too large: 53.95 km across or from the origin"));
    CHECK(holds(d.message, "boundary 'part' reaches from [5564.4, 53949.32, 5.38] to [5564.402"));
  }

  TEST_CASE("columns, references and fields that do not exist are said before the run") {
    const auto said = [](const std::string& more) {
      Diagnostics found;
      const Model m = read_deck_text(
          "dimension: 2\nresolution: 0.1\nend_time: 1\nmaterials: [{name: water, type: water}]\n"
          "probes: [{name: e, type: energy, every: 0.1}]\n" +
              more,
          {}, "deck", case_folder);
      check_outputs(m, found);
      return found.items().empty() ? ""
                                   : found.items()[0].id + " " + found.items()[0].path + ": " +
                                         found.items()[0].message + "; " + found.items()[0].help;
    };
    CHECK(said("output: {frames: {fields: [velocity, pressure]}}\n") == "");
    CHECK(holds(said("output: {frames: {fields: [velocty]}}\n"),
                "E152 output.frames.fields[0]: there is no field 'velocty'; did you mean "
                "'velocity'?"));
    CHECK(holds(said("output: {frames: {fields: [velocity, skin]}}\n"),
                "E152 output.frames.fields[1]: there is no field 'skin'"));
    const std::string claim = "expect: [{name: c, tolerance: 1, reduce: curve, ";
    CHECK(holds(said(claim + "probe: e.kinetik, reference_csv: motion/motion.csv}]\n"),
                "E150 expect[0].probe: probe 'e' has no column 'kinetik'; did you mean "
                "'kinetic'?"));
    CHECK(holds(said(claim + "probe: e.kinetic, reference_csv: motion/mm_header.csv}]\n"),
                "'mm' is not"));
    CHECK(said(claim + "probe: e.kinetic, reference_csv: motion/motion.csv}]\n") == "");
    CHECK(holds(said("expect: [{name: c, tolerance: 1, reduce: profile, probe: e, reference_csv: "
                     "motion/motion.csv}]\n"),
                "E155 expect[0].probe: 'e' is not a profile"));
  }
}
