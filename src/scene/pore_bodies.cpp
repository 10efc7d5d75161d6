// Which bodies of water are filled together, and what their particles depend on.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/hash.h"
#include "core/text.h"
#include "deck/yaml_writer.h"
#include "geometry/shapes.h"
#include "scene/body_filling.h"
#include "scene/pore_water.h"

namespace sphgeo {
namespace {

// Changes whenever other particles come out of the same deck.
constexpr const char* method_version = "2";

bool is_water(const Model& model, const Body& body) {
  const MaterialSpec* m = model.material(body.material);
  return m && m->phase() == "water" && body.shape;
}

Aabb common(Aabb a, const Aabb& b) {
  a.lo = a.lo.cwiseMax(b.lo);
  a.hi = a.hi.cwiseMin(b.hi);
  return a;
}

/// Whether some point of a lattice lies in both shapes; bodies that only touch have none.
bool overlap(const Shape& a, const Shape& b, double dp, int dim) {
  Aabb box = common(a.box(), b.box());
  if (dim == 2) box.lo.y() = box.hi.y() = 0;
  if (box.empty() || !box.lo.allFinite() || !box.hi.allFinite()) return false;
  const Vec3 size = box.hi - box.lo;
  // At most about a million points.
  const double most = dim == 3 ? 100 : 1000;
  Vec3 n = (size / dp).array().ceil().max(1.0).min(most);
  if (dim == 2) n.y() = 1;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i) {
        const Vec3 p = box.lo + size.cwiseProduct(
                                    Vec3((i + 0.5) / n.x(), (j + 0.5) / n.y(), (k + 0.5) / n.z()));
        if (a.bound(p) < -1e-6 * dp && b.bound(p) < -1e-6 * dp) return true;
      }
  return false;
}

bool boxes_meet(const Shape& a, const Shape& b, double reach) {
  return !common(a.box().grown(reach), b.box()).empty();
}

/// Whether a formula uses a name.
bool uses(const std::string& formula, const std::string& name) {
  const auto part_of_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  for (auto at = formula.find(name); at != std::string::npos; at = formula.find(name, at + 1)) {
    const auto end = at + name.size();
    if ((at == 0 || !part_of_name(formula[at - 1])) &&
        (end == formula.size() || !part_of_name(formula[end])))
      return true;
  }
  return false;
}

/// A shape as the deck gives it. What it reads from a file is told by its distances at some points,
/// to a millionth of its size: the name alone does not say what is in it.
Node described(const std::shared_ptr<const Shape>& shape) {
  WriteStyle style;
  style.for_hash = true;
  Node out = value_type<std::shared_ptr<const Shape>>().write(&shape, style);
  if (write_yaml(out).find("file:") == std::string::npos) return out;
  const Aabb box = shape->box();
  const double size = (box.hi - box.lo).norm();
  std::uint64_t hash = fnv1a_start;
  for (std::uint64_t k = 0; k < 64; ++k) {
    Vec3 p;
    for (int a = 0; a < 3; ++a)
      p[a] = box.lo[a] +
             random_uniform(7, 3 * k + static_cast<std::uint64_t>(a)) * (box.hi[a] - box.lo[a]);
    hash = fnv1a(fmt::format("{:.6f} ", std::round(1e6 * shape->signed_distance(p) / size) / 1e6),
                 hash);
  }
  Node both = Node::map();
  both.add("given", std::move(out));
  both.add("contents", Node::scalar(fmt::format("{:016x}", hash), true));
  return both;
}

}  // namespace

std::optional<PoreBodies> pore_bodies(const Model& model) {
  if (model.numerics.pore_water != "equal_mass") return std::nullopt;
  const WaterTarget target(model);
  if (target.soils().empty()) return std::nullopt;
  std::vector<std::size_t> water, chosen;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (is_water(model, model.bodies[b])) water.push_back(b);
  const auto shape = [&](std::size_t b) -> const Shape& { return *model.bodies[b].shape; };
  const auto take_if = [&](auto&& wanted) {
    const std::size_t before = chosen.size();
    std::erase_if(water, [&](std::size_t b) {
      if (!wanted(b)) return false;
      chosen.push_back(b);
      return true;
    });
    return chosen.size() > before;
  };
  const double dp = model.resolution;
  take_if([&](std::size_t b) {
    return std::any_of(target.soils().begin(), target.soils().end(),
                       [&](const WaterTarget::Skeleton& s) {
                         return overlap(shape(b), *s.shape, dp, model.dimension);
                       });
  });
  if (chosen.empty()) return std::nullopt;
  // A body that touches one of them is no free surface to it.
  while (take_if([&](std::size_t b) {
    return std::any_of(chosen.begin(), chosen.end(),
                       [&](std::size_t c) { return boxes_meet(shape(b), shape(c), 1e-6 * dp); });
  })) {
  }
  std::sort(chosen.begin(), chosen.end());
  PoreBodies out{chosen, model.bodies[chosen.front()].shape};
  if (chosen.size() > 1) {
    auto all = std::make_shared<Union>();
    all->flat = model.dimension == 2;
    for (const std::size_t b : chosen) all->of.push_back(model.bodies[b].shape);
    out.water = all;
  }
  return out;
}

std::string depends_on(const Model& model, const PoreBodies& pores) {
  Node out = Node::map();
  out.add("method", Node::scalar(method_version));
  out.add("dimension", Node::scalar(std::to_string(model.dimension)));
  out.add("resolution", Node::scalar(exact(model.resolution)));
  Node how = Node::map();
  how.add("steps", Node::scalar(std::to_string(model.relaxation.steps)));
  how.add("seed", Node::scalar(std::to_string(model.relaxation.seed)));
  how.add("tolerance", Node::scalar(exact(model.relaxation.tolerance)));
  how.add("acceptance", Node::scalar(model.relaxation.acceptance));
  out.add("relaxation", std::move(how));
  Node water = Node::list();
  for (const std::size_t b : pores.bodies) {
    Node body = Node::map();
    body.add("shape", described(model.bodies[b].shape));
    body.add("filling",
             Node::scalar(filling_of(model.bodies[b], model).relaxed ? "relaxed" : "lattice"));
    water.items.push_back(std::move(body));
  }
  out.add("water", std::move(water));
  Node soil = Node::list(), variables = Node::map();
  const WaterTarget target(model);
  std::string formulas;
  for (const WaterTarget::Skeleton& s : target.soils()) {
    if (!boxes_meet(*s.shape, *pores.water, 0)) continue;
    Node body = Node::map();
    body.add("shape", described(s.shape));
    body.add(s.porosity ? "porosity" : "volume_fraction", Node::scalar(s.amount.text()));
    formulas += s.amount.text() + " ";
    soil.items.push_back(std::move(body));
  }
  out.add("soil", std::move(soil));
  for (const auto& [name, value] : model.variables.values)
    if (uses(formulas, name)) variables.add(name, Node::scalar(exact(value)));
  if (!variables.entries.empty()) out.add("variables", std::move(variables));
  return write_yaml(out);
}

}  // namespace sphgeo
