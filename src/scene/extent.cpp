#include "scene/extent.h"

#include <fmt/format.h>

#include <vector>

#include "boundaries/boundary.h"

namespace sphgeo {
namespace {

constexpr double most_spacings = 1e6;

struct Part {
  std::string path, what;
  Aabb box;
};

// The bounded sides of a box; an unbounded side counts as if it were at the other one, or nowhere.
void extend(Aabb& all, const Aabb& box) {
  for (int k = 0; k < 3; ++k)
    for (const double side : {box.lo[k], box.hi[k]})
      if (std::isfinite(side)) {
        all.lo[k] = std::min(all.lo[k], side);
        all.hi[k] = std::max(all.hi[k], side);
      }
}

// What the domain keeps of a box; all of it where that is nothing, as it is far away then.
Aabb within_domain(const Aabb& box, const Numerics& n) {
  Aabb kept = box;
  if (n.domain_min) kept.lo = kept.lo.cwiseMax(*n.domain_min);
  if (n.domain_max) kept.hi = kept.hi.cwiseMin(*n.domain_max);
  return (kept.lo.array() <= kept.hi.array()).all() ? kept : box;
}

std::vector<Part> parts_of(const Model& model) {
  std::vector<Part> parts;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (model.bodies[b].shape)
      parts.push_back({fmt::format("bodies[{}].shape", b), "body '" + model.bodies[b].name + "'",
                       within_domain(model.bodies[b].shape->box(), model.numerics)});
  const Placement placement{model.resolution, 0.0, model.dimension};
  for (std::size_t b = 0; b < model.boundaries.size(); ++b) {
    const auto* wall = dynamic_cast<const WallBoundary*>(model.boundaries[b].get());
    const auto solid = wall ? wall->solid(placement) : nullptr;
    if (solid)
      parts.push_back({fmt::format("boundaries[{}]", b),
                       "boundary '" + model.boundaries[b]->name + "'",
                       within_domain(solid->box(), model.numerics)});
  }
  return parts;
}

// Across, or from the origin, whichever is more: frames keep seven digits of a coordinate.
double longest_side(const Aabb& box) {
  return std::max((box.hi - box.lo).maxCoeff(),
                  box.lo.cwiseAbs().cwiseMax(box.hi.cwiseAbs()).maxCoeff());
}

}  // namespace

void check_extent(const Model& model, Diagnostics& found) {
  const std::vector<Part> parts = parts_of(model);
  Aabb all;
  for (const Part& p : parts) extend(all, p.box);
  if (all.empty()) return;
  const double most = most_spacings * model.resolution;
  if (!(longest_side(all) > most)) return;
  // To blame is the part without which the scene is smallest.
  const Part* far = nullptr;
  double rest = longest_side(all);
  for (const Part& left_out : parts) {
    Aabb others;
    for (const Part& p : parts)
      if (&p != &left_out) extend(others, p.box);
    if (const double side = longest_side(others); !far || side < rest) {
      far = &left_out;
      rest = side;
    }
  }
  Aabb own;
  extend(own, far->box);
  found.error(
      "E146", model.place_of(far->path), far->path,
      fmt::format("the scene is too large: {:.4g} km across or from the origin, {:.3g} times its "
                  "resolution of {} m; "
                  "{} reaches "
                  "from [{:.9g}, {:.9g}, {:.9g}] to [{:.9g}, {:.9g}, {:.9g}] m",
                  longest_side(all) / 1000, longest_side(all) / model.resolution, model.resolution,
                  far->what, own.lo.x(), own.lo.y(), own.lo.z(), own.hi.x(), own.hi.y(),
                  own.hi.z()),
      fmt::format("at most {:.0e} spacings; coordinates of a map are moved to the origin by "
                  "`translate` or `map_origin`, millimetres become metres by `scale`",
                  most_spacings));
}

}  // namespace sphgeo
