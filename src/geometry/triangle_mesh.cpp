#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>

#include "geometry/distance.h"

namespace sphgeo {

namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

Vec3 area_vector(const Triangles& m, const std::array<std::int32_t, 3>& f) {
  const Vec3 &a = m.points[at(f[0])], &b = m.points[at(f[1])], &c = m.points[at(f[2])];
  return 0.5 * (b - a).cross(c - a);
}

struct Cell {
  std::int64_t x, y, z;
  bool operator==(const Cell&) const = default;
};
struct CellHash {
  std::size_t operator()(const Cell& c) const {
    std::uint64_t h = 0xcbf29ce484222325ull;
    for (const std::int64_t v : {c.x, c.y, c.z})
      h = (h ^ static_cast<std::uint64_t>(v)) * 0x9e3779b97f4a7c15ull + (h >> 29);
    return h;
  }
};

}  // namespace

Index weld(Triangles& mesh, double tolerance) {
  // Below the resolution of the numbers only equal corners are near, and cells that small could not
  // be counted.
  double largest = 0.0;
  for (const Vec3& p : mesh.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  if (tolerance < 1e-17 * largest) tolerance = 0.0;
  // Cells as wide as the tolerance: partners lie in the 27 cells around a corner. The first corner
  // of a cluster stays, so the result depends only on the order in the file.
  const double width = tolerance > 0.0 ? tolerance : 1e-300;
  std::unordered_map<Cell, std::vector<std::int32_t>, CellHash> cells;
  std::map<std::array<double, 3>, std::int32_t> equal;
  std::vector<std::int32_t> target(mesh.points.size());
  std::vector<Vec3> kept;
  auto cell_of = [&](const Vec3& p) {
    return Cell{std::llround(std::floor(p.x() / width)), std::llround(std::floor(p.y() / width)),
                std::llround(std::floor(p.z() / width))};
  };
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3& p = mesh.points[i];
    std::int32_t found = -1;
    const auto next = static_cast<std::int32_t>(kept.size());
    if (tolerance <= 0.0) {
      // Adding zero turns -0 into 0, which compares equal but is written differently.
      const auto [it, fresh] = equal.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}, next);
      if (!fresh) found = it->second;
    } else {
      const Cell c = cell_of(p);
      for (int k = 0; k < 27 && found < 0; ++k) {
        const auto it = cells.find({c.x + k % 3 - 1, c.y + k / 3 % 3 - 1, c.z + k / 9 - 1});
        if (it == cells.end()) continue;
        for (const std::int32_t j : it->second)
          if ((kept[at(j)] - p).norm() <= tolerance) {
            found = j;
            break;
          }
      }
      if (found < 0) cells[c].push_back(next);
    }
    if (found < 0) {
      found = next;
      kept.push_back(p);
    }
    target[i] = found;
  }
  std::vector<std::array<std::int32_t, 3>> faces;
  for (const auto& f : mesh.faces) {
    const std::array<std::int32_t, 3> g{target[at(f[0])], target[at(f[1])], target[at(f[2])]};
    if (g[0] != g[1] && g[1] != g[2] && g[2] != g[0]) faces.push_back(g);
  }
  const Index dropped = static_cast<Index>(mesh.faces.size() - faces.size());
  mesh.points = std::move(kept);
  mesh.faces = std::move(faces);
  return dropped;
}

Index drop_duplicates(Triangles& mesh) {
  using Face = std::array<std::int32_t, 3>;
  std::vector<std::pair<Face, std::size_t>> order;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Face key = mesh.faces[f];
    std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
    order.emplace_back(key, f);
  }
  std::sort(order.begin(), order.end());
  std::vector<char> repeated(mesh.faces.size(), 0);
  for (std::size_t k = 1; k < order.size(); ++k)
    repeated[order[k].second] = order[k].first == order[k - 1].first;
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (!repeated[f]) mesh.faces[kept++] = mesh.faces[f];
  const auto dropped = static_cast<Index>(mesh.faces.size() - kept);
  mesh.faces.resize(kept);
  return dropped;
}

MeshHealth repair_orientation(Triangles& mesh) {
  MeshHealth health;
  struct Use {
    std::int32_t face;
    bool forward;  // the face runs along the edge from the lower to the higher corner
  };
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<Use>> edges;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = mesh.faces[f][at(k)], b = mesh.faces[f][at((k + 1) % 3)];
      edges[std::minmax(a, b)].push_back({static_cast<std::int32_t>(f), a < b});
    }
  struct Link {
    std::int32_t face;
    bool turned;
  };
  std::vector<std::vector<Link>> links(mesh.faces.size());
  for (const auto& [edge, uses] : edges) {
    if (uses.size() == 1) {
      if (health.open_edges++ == 0)
        health.open_at = 0.5 * (mesh.points[at(edge.first)] + mesh.points[at(edge.second)]);
    } else if (uses.size() > 2) {
      ++health.non_manifold_edges;
    } else {
      const bool turned = uses[0].forward == uses[1].forward;
      links[at(uses[0].face)].push_back({uses[1].face, turned});
      links[at(uses[1].face)].push_back({uses[0].face, turned});
    }
  }
  // Spread the sense of one face over its connected part; the minority of each part is flipped.
  std::vector<signed char> sense(mesh.faces.size(), 0);
  for (std::size_t seed = 0; seed < mesh.faces.size(); ++seed) {
    if (sense[seed] != 0) continue;
    std::vector<std::int32_t> part{static_cast<std::int32_t>(seed)};
    sense[seed] = 1;
    std::size_t plus = 0;
    for (std::size_t k = 0; k < part.size(); ++k) {
      const std::int32_t f = part[k];
      plus += sense[at(f)] > 0;
      for (const Link& l : links[at(f)])
        if (sense[at(l.face)] == 0) {
          sense[at(l.face)] = static_cast<signed char>(l.turned ? -sense[at(f)] : sense[at(f)]);
          part.push_back(l.face);
        }
    }
    const signed char wrong = 2 * plus >= part.size() ? -1 : 1;
    for (const std::int32_t f : part)
      if (sense[at(f)] == wrong) {
        ++health.flipped_faces;
        std::swap(mesh.faces[at(f)][1], mesh.faces[at(f)][2]);
      }
  }
  if (enclosed_volume(mesh) < 0.0) {
    health.inside_out = true;
    for (auto& f : mesh.faces) std::swap(f[1], f[2]);
  }
  return health;
}

double enclosed_volume(const Triangles& mesh) {
  if (mesh.points.empty()) return 0.0;
  const Vec3 o = mesh.points.front();  // a nearby origin avoids cancellation
  double six = 0.0;
  for (const auto& f : mesh.faces)
    six +=
        (mesh.points[at(f[0])] - o).cross(mesh.points[at(f[1])] - o).dot(mesh.points[at(f[2])] - o);
  return six / 6.0;
}

double triangle_distance_squared(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 n = ab.cross(ac);
  const double n2 = n.squaredNorm();
  if (n2 > 0.0) {
    const double v = ap.cross(ac).dot(n), w = ab.cross(ap).dot(n);
    if (v >= 0.0 && w >= 0.0 && v + w <= n2) {
      const double d = ap.dot(n);
      return d * d / n2;
    }
  }
  const double d =
      std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
  return d * d;
}

SurfaceDistance::SurfaceDistance(Triangles mesh) : mesh_(std::move(mesh)) {
  std::vector<Aabb> boxes(mesh_.faces.size());
  for (std::size_t f = 0; f < boxes.size(); ++f)
    for (const std::int32_t k : mesh_.faces[f]) boxes[f].extend(mesh_.points[at(k)]);
  for (const Aabb& b : boxes) box_.extend(b);
  tree_ = BoxTree(boxes);
  dipoles_.resize(tree_.nodes().size());
  // Children follow their parent in the node array, so a backward walk meets them first.
  std::vector<double> weight(dipoles_.size(), 0.0);
  for (std::size_t k = dipoles_.size(); k-- > 0;) {
    const BoxTree::Node& node = tree_.nodes()[k];
    Dipole& d = dipoles_[k];
    Vec3 moment = Vec3::Zero();
    if (node.count > 0) {
      for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
        const auto& f = mesh_.faces[at(tree_.order()[at(i)])];
        const Vec3 area = area_vector(mesh_, f);
        const double size = area.norm();
        d.area += area;
        weight[k] += size;
        moment +=
            size * (mesh_.points[at(f[0])] + mesh_.points[at(f[1])] + mesh_.points[at(f[2])]) / 3.0;
      }
    } else {
      for (const std::int32_t child : {node.first, node.right}) {
        d.area += dipoles_[at(child)].area;
        weight[k] += weight[at(child)];
        moment += weight[at(child)] * dipoles_[at(child)].centre;
      }
    }
    d.centre = weight[k] > 0.0 ? Vec3(moment / weight[k]) : Vec3(0.5 * (node.box.lo + node.box.hi));
    d.radius = (node.box.hi - d.centre).cwiseMax(d.centre - node.box.lo).norm();
  }
}

double SurfaceDistance::inner_faces() const {
  constexpr std::size_t looked_at = 500;
  const std::size_t stride = 1 + mesh_.faces.size() / looked_at;
  Index all = 0, inner = 0;
  for (std::size_t f = 0; f < mesh_.faces.size(); f += stride) {
    const auto& face = mesh_.faces[f];
    const Vec3 &a = mesh_.points[at(face[0])], &b = mesh_.points[at(face[1])],
               &c = mesh_.points[at(face[2])];
    const Vec3 area = (b - a).cross(c - a);
    // A little before the face: outside of the solid, unless another part reaches there.
    const Vec3 before = (a + b + c) / 3 + 1e-3 * area / std::sqrt(area.norm());
    ++all;
    inner += winding_number(before) > 0.5 ? 1 : 0;
  }
  return all > 0 ? static_cast<double>(inner) / static_cast<double>(all) : 0;
}

double SurfaceDistance::winding_number(const Vec3& p) const {
  if (tree_.empty()) return 0.0;
  constexpr double far = 3.0;  // a node farther than this many radii counts as one dipole
  double sum = 0.0;
  std::int32_t stack[128];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const auto k = at(stack[--depth]);
    const Dipole& d = dipoles_[k];
    const Vec3 to = d.centre - p;
    const double distance = to.norm();
    if (distance > far * d.radius) {
      sum += d.area.dot(to) / (distance * distance * distance);
      continue;
    }
    const BoxTree::Node& node = tree_.nodes()[k];
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = node.right;
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      const auto& f = mesh_.faces[at(tree_.order()[at(i)])];
      const Vec3 a = mesh_.points[at(f[0])] - p, b = mesh_.points[at(f[1])] - p,
                 c = mesh_.points[at(f[2])] - p;
      const double la = a.norm(), lb = b.norm(), lc = c.norm();
      // Solid angle of a triangle (van Oosterom and Strackee, 1983).
      sum += 2.0 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
  }
  return sum / (4.0 * std::numbers::pi);
}

double SurfaceDistance::signed_distance(const Vec3& p) const {
  const double best2 =
      tree_.nearest(p, std::numeric_limits<double>::infinity(), [&](std::int32_t i) {
        const auto& f = mesh_.faces[at(i)];
        return triangle_distance_squared(p, mesh_.points[at(f[0])], mesh_.points[at(f[1])],
                                         mesh_.points[at(f[2])]);
      });
  const double distance = std::sqrt(best2);
  if (!box_.contains(p)) return distance;
  return winding_number(p) > 0.5 ? -distance : distance;
}

}  // namespace sphgeo
