#include "scene/body_filling.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "geometry/fill.h"
#include "geometry/relaxation.h"
#include "geometry/shapes.h"
#include "materials/solid.h"

namespace sphgeo {

FillingChoice filling_of(const Body& body, const Model& model) {
  if (body.filling != "auto") return {body.filling == "relaxed", "as the deck says"};
  const SolidMaterial* solid = solid_of(model, body);
  if (!solid) return {false, "as the walls beside water and soil"};
  if (!solid->rigid()) return {false, "an elastic solid with sharp or thin parts needs one"};
  if (body.shape->along_axes()) return {false, "its faces lie along the axes"};
  return {true, "no lattice fits its shape"};
}

namespace {

/// Throws Error (usage) for shapes that are unbounded or too large.
BodyPoints fill_shape(const Body& body, const Model& model, double dp) {
  if (!filling_of(body, model).relaxed) {
    if (const auto* box = dynamic_cast<const Box*>(body.shape.get())) {
      FilledBox filled = fill_box(*box, dp, model.dimension);
      return {std::move(filled.at), filled.volume};
    }
    return {fill_lattice(*body.shape, dp, model.dimension), std::pow(dp, model.dimension)};
  }
  RelaxedPositions relaxed = relax_fill(*body.shape, dp, model.dimension);
  return {std::move(relaxed.at), relaxed.volume};
}

}  // namespace

BodyPoints fill_body(const Model& model, std::size_t b, Diagnostics& found,
                     const std::vector<Vec3>* given) {
  const Body& body = model.bodies[b];
  const Numerics& n = model.numerics;
  const double dp = body.spacing.value_or(model.resolution);
  const std::string path = fmt::format("bodies[{}].shape", b);
  BodyPoints points{{}, 0};
  try {
    points =
        given ? BodyPoints{*given, std::pow(dp, model.dimension)} : fill_shape(body, model, dp);
  } catch (const Error& e) {
    found.error("E113", model.place_of(path), path, e.what());
    return points;
  }
  if (points.at.empty())
    found.error(
        "E110", model.place_of(path), path, "the body holds no particle",
        fmt::format("it is smaller than its spacing of {} m, or lies outside the plane of a "
                    "2D scene",
                    dp));
  if (n.lattice_jitter > 0 && !given) {
    // Bodies of equal shape get different jitter.
    const std::uint64_t seed =
        random_bits(static_cast<std::uint64_t>(n.lattice_seed), fnv1a(body.name));
    parallel_for(static_cast<Index>(points.at.size()), [&](Index k) {
      for (int axis = 0; axis < 3; ++axis)
        if (axis != 1 || model.dimension == 3)
          points.at[static_cast<std::size_t>(k)][axis] +=
              (2 * random_uniform(seed, static_cast<std::uint64_t>(3 * k + axis)) - 1) *
              n.lattice_jitter * dp;
    });
  }
  return points;
}

}  // namespace sphgeo
