// The files of share/inputs: the same motion and the same terrain in every form that is read.

#include <doctest/doctest.h>

#include <filesystem>

#include "boundaries/boundary.h"
#include "core/error.h"
#include "deck/model.h"
#include "deck/motion.h"
#include "scene/extent.h"

using namespace sphgeo;

namespace {

const std::string input_folder = SPHGEO_SOURCE_DIR "/share/inputs";

Model deck_with(const std::string& boundary) {
  return read_deck_text(
      "dimension: 3\nresolution: 0.05\nend_time: 1\nmaterials: [{name: water, type: water}]\n"
      "boundaries: [{name: part, type: wall, " +
          boundary + "}]\n",
      {}, "deck", input_folder);
}

ShapePtr terrain_of(const std::string& keys) {
  const Model m = deck_with("shape: {type: height_field, bottom: -0.5, file: " + keys + "}");
  return dynamic_cast<const WallBoundary&>(*m.boundaries[0]).solid({0.05, 0.1, 3});
}

std::string complaint_about(const std::string& boundary) {
  try {
    deck_with(boundary);
  } catch (const DeckError& e) {
    return e.diagnostics.items().at(0).message;
  }
  return {};
}

}  // namespace

TEST_SUITE("scene") {
  TEST_CASE("the motion of share/inputs is the same in all forms of table") {
    std::vector<std::shared_ptr<const Motion>> motions;
    for (const char* file :
         {"motion.csv", "motion_units.csv", "motion_semicolons.csv", "motion_blanks.txt"}) {
      const Model m = deck_with(
          std::string("shape: {type: box, min: [0, 0, 0], max: [1, 1, 1]}, motion: {table: ") +
          file + "}");
      motions.push_back(std::make_shared<const Motion>(
          *dynamic_cast<const WallBoundary&>(*m.boundaries[0]).motion));
    }
    const Vec3 corner(1, 0, 1);
    CHECK(motions[0]->position(corner, 0.5).x() == doctest::Approx(1.05));
    for (const double t : {0.0, 0.1, 0.25, 0.6, 1.0})
      for (const auto& m : motions)
        CHECK((m->position(corner, t) - motions[0]->position(corner, t)).norm() < 1e-9);
  }

  TEST_CASE("the terrain of share/inputs is the same in all forms of file") {
    const std::vector<ShapePtr> terrains{
        terrain_of("terrain_grid.csv, spacing: 0.1"), terrain_of("terrain_points.csv"),
        terrain_of("terrain.asc"),
        terrain_of("terrain_map.asc, map_origin: [556440, 5394932, 500]")};
    for (const Vec3& at : {Vec3(0, 0, 0.35), Vec3(0.33, 0.17, 0.1), Vec3(0.6, 0.4, 0.3)})
      for (const ShapePtr& t : terrains)
        CHECK(t->signed_distance(at) ==
              doctest::Approx(terrains[0]->signed_distance(at)).epsilon(1e-6));
    CHECK(terrains[0]->box().hi.x() == doctest::Approx(0.6));
  }

  TEST_CASE("map coordinates and holes of share/inputs are said, and what to do") {
    const std::string shape = "shape: {type: height_field, bottom: -0.5, file: ";
    CHECK(complaint_about(shape + "terrain_map.asc}").find("map_origin: [556440") !=
          std::string::npos);
    CHECK(complaint_about(shape + "terrain_holes.asc}").find("3 of 35 heights are missing") !=
          std::string::npos);
    // Filled, they lie within a few millimetres of the surface that was there.
    const ShapePtr whole = terrain_of("terrain.asc"),
                   filled = terrain_of("terrain_holes.asc, holes: fill");
    CHECK(std::abs(filled->signed_distance({0.3, 0.2, 0.25}) -
                   whole->signed_distance({0.3, 0.2, 0.25})) < 0.01);
  }

  TEST_CASE("a scene too large for its spacing is refused, naming what lies far away") {
    const std::string said = [&] {
      Diagnostics found;
      const Model m = deck_with(
          "shape: {type: box, min: [556440, 5394932, 0], max: [556441, 5394933, 1]}},"
          "{name: near, type: wall, shape: {type: box, min: [0, 0, 0], max: [1, 1, 1]}");
      check_extent(m, found);
      return found.items().empty() ? "" : found.items()[0].id + " " + found.items()[0].message;
    }();
    CAPTURE(said);
    CHECK(said.find("E146 the scene is too large: 5395 km across or from the origin") == 0);
    CHECK(said.find("boundary 'part'") != std::string::npos);
  }
}
