// Files that a deck names: terrain, tables of motion, reference curves.

#include <cmath>

#include "core/error.h"
#include "deck/motion.h"
#include "deck/reference_curve.h"
#include "deck/yaml_reader.h"
#include "geometry/shapes.h"
#include "geometry/terrain_file.h"
#include "targets.h"

namespace sphgeo::fuzz {

namespace {

void use_terrain(HeightField& field) {
  try {
    field.prepare();
  } catch (const Error&) {
    return;
  }
  Diagnostics found;
  const Places nowhere;
  CheckContext context(found, nowhere, "shape", 3);
  field.inspect(context);
  const Aabb box = field.box();
  require(!box.empty(), "a terrain has a box");
  for (const Vec3& at : {Vec3(0, 0, 0), Vec3(0.7, 0.2, box.hi.z() - 0.1), Vec3(-1, 9, 0)})
    require(!std::isnan(field.signed_distance(at)), "the distance to a terrain is a number");
}

void check_grid(const std::string& path, const std::string& format) {
  try {
    const TerrainGrid grid = read_terrain(path, format, std::nullopt);
    require(grid.nx > 0 && grid.ny >= 0 &&
                grid.heights.size() ==
                    static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny),
            "a grid has all its nodes");
  } catch (const Error& e) {
    require(std::string(e.what()).find(path) != std::string::npos, "an error names the file");
  }
}

/// The motion of a deck that names the table, or nothing with an error for the user.
std::optional<Motion> read_motion(const std::string& path, int dimension) {
  Diagnostics found;
  Places places;
  DeckReading reading(found, places);
  reading.dimension = dimension;
  reading.folder = ".";
  const std::optional<Node> node = read_yaml("{table: " + path + "}", "deck", found);
  const ValueType& type = value_type<Motion>();
  Motion motion;
  const Key key("motion", type, unit::none, true, "", [](void* p) { return p; });
  const bool read = node && type.read(*node, key, "motion", reading, &motion);
  if (read)
    for (const auto& rule : reading.rules) rule();
  if (!found.has_errors()) {
    require(read, "what cannot be read has an error");
    return motion;
  }
  return std::nullopt;
}

}  // namespace

void run_terrain(std::string_view input) {
  const MemoryFile file(input);
  for (const char* format : {"auto", "grid", "points", "esri"}) check_grid(file.path(), format);
  for (const char* holes : {"refuse", "fill"})
    for (const bool flat : {false, true}) {
      HeightField field;
      field.file = FilePath{file.path()};
      field.holes = holes;
      field.flat = flat;
      use_terrain(field);
      field.spacing = 0.5;
      use_terrain(field);
    }
}

void run_motion(std::string_view input) {
  const MemoryFile file(input);
  for (const int dimension : {2, 3}) {
    const std::optional<Motion> motion = read_motion(file.path(), dimension);
    if (!motion) continue;
    for (const double t : {0.0, 1e-3, 0.5, 1.0, 1e6})
      require(motion->position({1, 0, 2}, t).allFinite() &&
                  motion->velocity({1, 0, 2}, t).allFinite() &&
                  motion->acceleration({1, 0, 2}, t).allFinite(),
              "a motion that is read is finite at all times");
  }
}

void run_reference(std::string_view input) {
  const MemoryFile file(input);
  for (const std::optional<std::string_view> unit :
       {std::optional<std::string_view>(), std::optional<std::string_view>("Pa"),
        std::optional<std::string_view>("m/s"), std::optional<std::string_view>("")}) {
    Expect claim;
    claim.reference_csv = FilePath{file.path()};
    if (unit == "Pa") claim.norm = "relative_l2";
    for (const bool scaled : {false, true}) {
      if (scaled) claim.x_scale = claim.y_scale = 0.5;
      try {
        const ReferenceCurve curve = read_reference(claim, unit);
        require(curve.x.size() == curve.y.size(), "a curve has as many x as y");
        for (std::size_t k = 0; k < curve.x.size(); ++k)
          require(!std::isinf(curve.x[k]) && !std::isinf(curve.y[k]), "no point is at infinity");
      } catch (const Error& e) {
        require(std::string(e.what()).find(file.path()) != std::string::npos,
                "an error names the file");
      }
    }
  }
}

}  // namespace sphgeo::fuzz
