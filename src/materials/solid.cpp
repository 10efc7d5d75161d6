#include "materials/solid.h"

#include <algorithm>

namespace sphgeo {
namespace {

double spacing_of(const Model& model, const Body& body) {
  return body.spacing.value_or(model.resolution);
}

}  // namespace

bool has_solids(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [&](const Body& b) { return solid_of(model, b) != nullptr; });
}

std::vector<double> solid_spacings(const Model& model) {
  std::vector<double> spacings;
  for (const Body& b : model.bodies)
    if (solid_of(model, b) &&
        std::find(spacings.begin(), spacings.end(), spacing_of(model, b)) == spacings.end())
      spacings.push_back(spacing_of(model, b));
  return spacings;
}

std::string solid_set_name(std::size_t spacing) {
  return spacing == 0 ? "solids" : "solids_" + std::to_string(spacing + 1);
}

std::string solid_set_of(const Model& model, std::size_t body) {
  const Body& b = model.bodies[body];
  if (!solid_of(model, b)) return "";
  const std::vector<double> spacings = solid_spacings(model);
  return solid_set_name(static_cast<std::size_t>(
      std::find(spacings.begin(), spacings.end(), spacing_of(model, b)) - spacings.begin()));
}

}  // namespace sphgeo
