#include "geometry/mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <unordered_map>

#include "core/error.h"
#include "core/parallel.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

SurfaceMesh closed_outline(const std::vector<Vec2>& corners) {
  SurfaceMesh mesh;
  const auto n = static_cast<std::int32_t>(corners.size());
  const bool left = polygon_area(corners) > 0.0;
  for (std::int32_t k = 0; k < n; ++k) {
    mesh.points.emplace_back(corners[at(k)].x(), 0.0, corners[at(k)].y());
    const std::int32_t next = (k + 1) % n;
    mesh.segments.push_back(left ? std::array{k, next} : std::array{next, k});
  }
  return mesh;
}

SurfaceMesh box_surface(const Box& box) {
  SurfaceMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.points.emplace_back((k & 1 ? box.max : box.min).x(), (k & 2 ? box.max : box.min).y(),
                             (k & 4 ? box.max : box.min).z());
  constexpr std::array<std::array<std::int32_t, 4>, 6> faces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

/// Signed distances at the nodes of a grid, and the surface points on its edges.
class Contour {
 public:
  Contour(const Shape& shape, const Aabb& box, double spacing, int dim)
      : shape_(shape), spacing_(spacing), origin_(box.lo.array() - 1.0 * spacing) {
    if (dim == 2) origin_.y() = 0.0;
    for (int k = 0; k < 3; ++k)
      n_[k] = dim == 2 && k == 1
                  ? 1
                  : static_cast<Index>(std::ceil((box.hi[k] - box.lo[k]) / spacing)) + 3;
    value_.resize(at(n_[0] * n_[1] * n_[2]));
    parallel_for(static_cast<Index>(value_.size()), [&](Index i) {
      const double d = shape_.bound(position(i));
      // A node exactly on the surface would make triangles without area; one on a seam is inside.
      const double least = 1e-6 * spacing_;
      const bool solid =
          d < 0.0 || (d < least && on_inner_seam(shape_, position(i), 1e-3 * spacing_, n_[1] == 1));
      value_[at(i)] = std::abs(d) < least ? (solid ? -least : least) : d;
    });
  }

  /// Marching tetrahedra: six around a diagonal of each cell, the same in all, so faces match.
  void triangulate() {
    // Each layer of cells by itself, from all threads; points are numbered in the order of cells.
    std::vector<std::vector<Facet>> layers(at(n_[2] - 1));
    parallel_blocks(n_[2] - 1, 1, [&](Index z, Index, Index) { cut_layer(z, layers[at(z)]); });
    std::size_t count = 0;
    for (const auto& layer : layers) count += layer.size();
    std::vector<Facet> facets;
    facets.reserve(count);
    seen_.reserve(count / 2 + 16);  // a closed surface of triangles has half as many points
    for (auto& layer : layers) {
      for (Facet& f : layer) {
        for (std::size_t k = 0; k < 3; ++k) f.corners[k] = crossing(f.edges[k][0], f.edges[k][1]);
        facets.push_back(f);
      }
      layer = {};
    }
    place_points();
    mesh_.triangles.resize(facets.size());
    parallel_for(static_cast<Index>(facets.size()),
                 [&](Index i) { mesh_.triangles[at(i)] = triangle(facets[at(i)]); });
  }

  /// Marching squares; the two ambiguous cases are decided by the centre of the square.
  void outline() {
    for (Index z = 0; z + 1 < n_[2]; ++z)
      for (Index x = 0; x + 1 < n_[0]; ++x) {
        const Index o = z * n_[0] + x;
        const std::array<Index, 4> c{o, o + 1, o + 1 + n_[0], o + n_[0]};  // counter-clockwise
        // An edge that leaves the solid starts a segment, one that enters ends it: solid to the
        // left.
        std::array<std::int32_t, 4> leave{}, enter{};
        int leaves = 0, enters = 0, first_leave = 0, first_enter = 0;
        for (int k = 0; k < 4; ++k) {
          const Index a = c[at(k)], b = c[at((k + 1) % 4)];
          if (inside(a) && !inside(b)) {
            if (leaves == 0) first_leave = k;
            leave[at(leaves++)] = crossing(a, b);
          } else if (!inside(a) && inside(b)) {
            if (enters == 0) first_enter = k;
            enter[at(enters++)] = crossing(a, b);
          }
        }
        if (leaves == 1) add_segment(leave[0], enter[0]);
        if (leaves == 2) {
          const Vec3 middle = 0.5 * (position(c[0]) + position(c[2]));
          const bool solid_middle = shape_.bound(middle) < 0.0;
          // Connected solid: cut off the empty corner, whose entering edge follows the leaving one.
          const bool follows = (first_enter == first_leave + 1) == solid_middle;
          add_segment(leave[0], enter[follows ? 0 : 1]);
          add_segment(leave[1], enter[follows ? 1 : 0]);
        }
      }
    place_points();
  }

  SurfaceMesh take() { return std::move(mesh_); }

 private:
  using Edge = std::array<Index, 2>;  ///< its nodes
  /// A triangle by the edges that its corners lie on.
  struct Facet {
    std::array<Edge, 3> edges;  ///< in the order in which the points on them are numbered
    Vec3 outward;
    std::array<std::int32_t, 3> corners;
    bool backwards;  ///< whether the triangle has them in the opposite order
  };

  void cut_layer(Index z, std::vector<Facet>& facets) const {
    constexpr int paths[6][2] = {{1, 2}, {2, 1}, {0, 2}, {2, 0}, {0, 1}, {1, 0}};
    const std::array<Index, 3> step{1, n_[0], n_[0] * n_[1]};
    for (Index y = 0; y + 1 < n_[1]; ++y)
      for (Index x = 0; x + 1 < n_[0]; ++x) {
        const Index o = (z * n_[1] + y) * n_[0] + x;
        // The bound excludes most cells, which are far from the surface.
        if (std::abs(value_[at(o)]) > 1.75 * spacing_) continue;
        for (int t = 0; t < 6; ++t) {
          const int last = paths[t][0], middle = paths[t][1], first = 3 - last - middle;
          const Index a = o + step[at(first)], b = a + step[at(middle)];
          tetrahedron({o, a, b, b + step[at(last)]}, facets);
        }
      }
  }

  Vec3 position(Index i) const {
    return origin_ + spacing_ * Vec3(static_cast<double>(i % n_[0]),
                                     static_cast<double>(i / n_[0] % n_[1]),
                                     static_cast<double>(i / (n_[0] * n_[1])));
  }
  bool inside(Index i) const { return value_[at(i)] < 0.0; }

  /// Number of the surface point on the edge between two nodes.
  std::int32_t crossing(Index a, Index b) {
    if (a > b) std::swap(a, b);
    const auto [it, fresh] =
        seen_.try_emplace(static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b),
                          static_cast<std::int32_t>(edges_.size()));
    if (fresh) edges_.push_back({a, b});
    return it->second;
  }

  void place_points() {
    mesh_.points.resize(edges_.size());
    parallel_for(static_cast<Index>(edges_.size()),
                 [&](Index i) { mesh_.points[at(i)] = surface_point(edges_[at(i)]); });
  }

  // Regula falsi with halving: linear between the nodes is off where the surface is curved.
  Vec3 surface_point(const Edge& edge) const {
    Vec3 p = position(edge[0]), q = position(edge[1]);
    double vp = value_[at(edge[0])], vq = value_[at(edge[1])];
    Vec3 m = p;
    for (int k = 0; k < 8; ++k) {
      const double s = k % 3 == 2 ? 0.5 : vp / (vp - vq);
      m = p + s * (q - p);
      const double v = shape_.bound(m);
      if (std::abs(v) < 1e-7 * spacing_) break;
      ((v < 0.0) == (vp < 0.0) ? p : q) = m;
      ((v < 0.0) == (vp < 0.0) ? vp : vq) = v;
    }
    return m;
  }

  void add_segment(std::int32_t a, std::int32_t b) { mesh_.segments.push_back({a, b}); }

  std::array<std::int32_t, 3> triangle(const Facet& f) const {
    auto [a, b, c] = f.corners;
    if (f.backwards) std::swap(a, c);
    const Vec3 &p = mesh_.points[at(a)], &q = mesh_.points[at(b)], &r = mesh_.points[at(c)];
    if ((q - p).cross(r - p).dot(f.outward) < 0.0) std::swap(b, c);
    return {a, b, c};
  }

  void tetrahedron(const std::array<Index, 4>& corner, std::vector<Facet>& facets) const {
    std::array<Index, 4> in{}, out{};
    int ins = 0, outs = 0;
    for (const Index c : corner) (inside(c) ? in[at(ins++)] : out[at(outs++)]) = c;
    if (ins == 0 || outs == 0) return;
    Vec3 outward = Vec3::Zero();
    for (int k = 0; k < outs; ++k) outward += position(out[at(k)]) / outs;
    for (int k = 0; k < ins; ++k) outward -= position(in[at(k)]) / ins;
    if (ins == 2) {
      const Edge a{in[0], out[0]}, b{in[0], out[1]}, c{in[1], out[1]}, d{in[1], out[0]};
      facets.push_back({{a, b, c}, outward, {}, false});
      facets.push_back({{a, c, d}, outward, {}, false});
      return;
    }
    const Index tip = ins == 1 ? in[0] : out[0];
    const auto& base = ins == 1 ? out : in;
    facets.push_back(
        {{Edge{tip, base[2]}, Edge{tip, base[1]}, Edge{tip, base[0]}}, outward, {}, true});
  }

  const Shape& shape_;
  double spacing_;
  Vec3 origin_;
  std::array<Index, 3> n_{};
  std::vector<double> value_;
  std::unordered_map<std::uint64_t, std::int32_t> seen_;
  std::vector<Edge> edges_;
  SurfaceMesh mesh_;
};

/// A shape cut by the clip box, so that an unbounded one closes there.
struct Clipped final : BoundedShape {
  const Shape* shape = nullptr;
  Aabb clip;
  double bound(const Vec3& p) const override {
    return std::max(shape->bound(p), box_distance(p, clip.lo, clip.hi, flat));
  }
  double signed_distance(const Vec3& p) const override { return bound(p); }
  Aabb box() const override { return clip; }
};

}  // namespace

SurfaceMesh surface_mesh(const Shape& shape, double spacing, int dim, const Aabb& clip) {
  Aabb box = shape.box();
  bool cut = false;
  if (!clip.empty()) {
    for (int k = 0; k < 3; ++k)
      if (!(dim == 2 && k == 1)) cut = cut || box.lo[k] < clip.lo[k] || box.hi[k] > clip.hi[k];
    box.lo = box.lo.cwiseMax(clip.lo);
    box.hi = box.hi.cwiseMin(clip.hi);
  }
  if (dim == 2) box.lo.y() = box.hi.y() = 0.0;
  if (box.empty()) return {};
  if (!box.lo.allFinite() || !box.hi.allFinite())
    throw Error(ExitCode::usage, "the shape is unbounded and has no finite surface");
  if (!cut) {
    if (const auto* b = dynamic_cast<const Box*>(&shape))
      return dim == 3 ? box_surface(*b)
                      : closed_outline({{b->min.x(), b->min.z()},
                                        {b->max.x(), b->min.z()},
                                        {b->max.x(), b->max.z()},
                                        {b->min.x(), b->max.z()}});
    if (const auto* p = dynamic_cast<const Polygon*>(&shape); p && dim == 2)
      return closed_outline(p->corners());
    if (const auto* s = dynamic_cast<const Stl*>(&shape); s && dim == 3)
      return {s->triangles().points, s->triangles().faces, {}};
  }
  // At most 2e7 nodes, so that a shape far larger than the spacing does not exhaust the memory.
  const Vec3 size = box.hi - box.lo;
  const auto nodes = [&](double h) {
    double n = 1.0;
    for (int k = 0; k < 3; ++k)
      if (!(dim == 2 && k == 1)) n *= size[k] / h + 3.0;
    return n;
  };
  while (nodes(spacing) > 2e7) spacing *= 1.1;
  Clipped cut_shape;
  cut_shape.shape = &shape;
  cut_shape.clip = box;
  cut_shape.flat = dim == 2;
  Contour contour(cut ? static_cast<const Shape&>(cut_shape) : shape, box, spacing, dim);
  if (dim == 3) contour.triangulate();
  else contour.outline();
  return contour.take();
}

}  // namespace sphgeo
