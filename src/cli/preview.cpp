#include "cli/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/atomic_file.h"
#include "probes/probe.h"
#include "report/painter.h"
#include "report/scene_pictures.h"
#include "run/boundary_mesh.h"

namespace sphgeo {

namespace {

struct NamedColor {
  const char* name;
  Color color;
};

/// Walls and probes come first, then water and soil, then what solids alternate between.
constexpr NamedColor colors[] = {
    {"grey", {0.50, 0.52, 0.55, 1}},   {"red", {0.84, 0.10, 0.13, 1}},
    {"blue", {0.36, 0.62, 0.86, 1}},   {"ochre", {0.80, 0.64, 0.36, 1}},
    {"violet", {0.55, 0.42, 0.72, 1}}, {"green", {0.40, 0.66, 0.45, 1}},
    {"pink", {0.86, 0.52, 0.66, 1}},   {"brown", {0.55, 0.42, 0.34, 1}}};
namespace color_number {
constexpr int wall = 0, probe = 1, water = 2, soil = 3, solid = 4, solids = 4;
}

constexpr int most_width = 1400, most_height = 1000;  // pixels
/// Margin around the particles in which walls and probes are shown, over the extent of the
/// particles.
constexpr double reach = 4;

/// The positions of all probes that have one.
template <int Dim>
std::vector<Vec3> probe_places(const Model& model) {
  std::vector<Vec3> positions;
  for (const auto& spec : model.probes)
    for (const Vec3& at : dynamic_cast<const Probe&>(*spec).positions())
      if (at.allFinite()) positions.push_back(to_space<Dim>(to_scene<Dim>(at)));
  return positions;
}

}  // namespace

template <int Dim>
std::string write_preview(const Model& model, const World<Dim>& world, const std::string& path) {
  Aabb particles, surroundings;
  std::map<std::string, std::vector<Vec3>> positions;
  for (const auto& set : world.sets()) {
    if (set->phase() == "wall") continue;
    std::vector<Vec3>& at = positions[set->name()];
    const auto& x = set->vector(fields::position);
    for (Index i = 0; i < set->size(); ++i) at.push_back(to_space<Dim>(x[i]));
    for (const Vec3& p : at) particles.extend(p);
  }
  if (!particles.empty()) particles = particles.grown(model.resolution / 2);
  const BoundaryMesh walls = boundary_mesh(model);
  for (const Vec3& p : walls.points) surroundings.extend(p);
  const std::vector<Vec3> probes = probe_places<Dim>(model);
  for (const Vec3& p : probes) surroundings.extend(p);
  Aabb box = picture_box(particles, surroundings, reach);
  if (box.empty())
    box = {Vec3::Constant(-model.resolution),
           Vec3::Constant(model.resolution)};  // for example only material points

  std::vector<Color> palette;
  for (const NamedColor& c : colors) palette.push_back(c.color);
  const View view = view_of(box, Dim, most_width, most_height);
  Painter painter(view, palette);
  std::string legend;
  const auto name = [&](const std::string& what, int color) {
    legend += (legend.empty() ? "" : ", ") + what + " " + colors[color].name;
  };
  const auto draw_walls = [&] {
    for (const auto& [a, b] : outline(walls.points, Dim, walls.corners))
      painter.line(walls.points[static_cast<std::size_t>(a)],
                   walls.points[static_cast<std::size_t>(b)], 2, color_number::wall);
  };
  if (Dim == 3) draw_walls();
  for (const std::string_view kind :
       {"water", "soil", "solid"})  // soil above the water in its pores
    for (const auto& set : world.sets()) {
      const std::vector<Vec3>& at = positions[set->name()];
      if (set->phase() != kind || at.empty()) continue;
      const int color = kind == "water"  ? color_number::water
                        : kind == "soil" ? color_number::soil
                                         : color_number::solid;
      std::vector<std::uint8_t> tints(at.size(), static_cast<std::uint8_t>(color));
      if (color == color_number::solid && set->has(fields::part)) {
        const auto& part = set->tag(fields::part);
        for (std::size_t i = 0; i < at.size(); ++i)
          tints[i] = static_cast<std::uint8_t>(
              color_number::solid + std::abs(part[static_cast<Index>(i)]) % color_number::solids);
      }
      const double spacing = at.size() > 1 ? typical_spacing(at) : model.resolution;
      painter.discs(at, disc_cover(view, spacing) * spacing, tints,
                    color == color_number::water ? 0 : 0.3 * spacing);
      name(set->name(), tints.front());
    }
  if (Dim == 2) draw_walls();
  for (const Vec3& at : probes) painter.mark(at, 7, color_number::probe);
  if (!walls.part.empty()) name("boundaries", color_number::wall);
  if (!probes.empty()) name("probes", color_number::probe);
  Picture picture = painter.picture();
  picture.palette.front() = {1, 1, 1, 1};  // visible on any screen
  write_file_atomically(path, png(picture));
  return legend;
}

template std::string write_preview<2>(const Model&, const World<2>&, const std::string&);
template std::string write_preview<3>(const Model&, const World<3>&, const std::string&);

}  // namespace sphgeo
