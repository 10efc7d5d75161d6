#include <fmt/format.h>

#include <filesystem>
#include <iostream>

#include "boundaries/boundary.h"
#include "cli/commands.h"
#include "core/error.h"
#include "core/text.h"
#include "deck/model.h"
#include "geometry/mesh.h"
#include "geometry/stl_file.h"
#include "scene/build.h"

namespace sphgeo {
namespace {

/// The solid of that name in the deck; throws Error (usage) when there is none.
std::shared_ptr<const Shape> solid_named(const Model& model, const std::string& name) {
  std::vector<std::string> names;
  for (const Body& body : model.bodies) {
    if (body.name == name) return body.shape;
    names.push_back(body.name);
  }
  const Placement placement{model.resolution, support_radius(model), model.dimension};
  for (const auto& boundary : model.boundaries) {
    const auto* wall = dynamic_cast<const WallBoundary*>(boundary.get());
    const auto solid = wall ? wall->solid(placement) : nullptr;
    if (!solid) continue;
    if (boundary->name == name) return solid;
    names.push_back(boundary->name);
  }
  throw Error(ExitCode::usage,
              fmt::format("no body and no wall of the deck is named '{}'; {}", printable(name),
                          printable(suggestion(name, names, "bodies and walls"))));
}

}  // namespace

int export_command(const ExportOptions& options) {
  const Model model = read_deck(options.deck, options.set);
  if (model.dimension != 3)
    throw Error(ExitCode::usage,
                "STL needs a scene in 3D; --set dimension=3 may make this deck one");
  const auto solid = solid_named(model, options.name);
  const double spacing = options.spacing.value_or(0.5 * model.resolution);
  if (!(spacing > 0))
    throw Error(ExitCode::usage,
                fmt::format("--spacing {} is not a length above zero", exact(spacing)));
  if (!options.overwrite && std::filesystem::exists(options.output))
    throw Error(ExitCode::usage,
                fmt::format("{} exists; --overwrite replaces it", printable(options.output)));
  SurfaceMesh mesh = surface_mesh(*solid, spacing, 3);
  write_stl(options.output, {std::move(mesh.points), std::move(mesh.triangles)});
  std::cout << fmt::format("{}: {} triangles\n", printable(options.output),
                           (std::filesystem::file_size(options.output) - 84) / 50);
  return 0;
}

}  // namespace sphgeo
