#pragma once
// The background mesh of level-set-guided relaxation: distances near the surface, and what kernels
// miss beyond it.

#include <array>
#include <cstdint>
#include <vector>

#include "deck/interfaces.h"

namespace sphgeo {

/// Signed distances on a mesh in a band around the surface, and at each of its nodes the sums over
/// the outside, sum_l grad W V_l and sum_l W V_l with zeta_l > 0 (second sum of Eq. 84). They
/// depend on the shape alone, so they are summed once and interpolated for the particles.
template <int Dim>
class LevelSetMesh {
 public:
  /// Around a box [m], for smoothing length h [m]; nodes are h / 2.6 apart, and distances are known
  /// within `band` [m] of the surface. Within a node distance of the level set `level` [m] it is
  /// prepared for move_below().
  LevelSetMesh(const Shape& shape, const Aabb& around, double h, double band, double level);
  /// Of the same shape for a larger smoothing length, with the distances of another mesh.
  LevelSetMesh(const Shape& shape, const LevelSetMesh& finer, double h);

  struct Missing {
    Vec<Dim> gradient = Vec<Dim>::Zero();  ///< 1/m
    double sum = 0.0;
  };
  /// Interpolated at p; zero deep inside.
  Missing missing(const Vec<Dim>& p) const;

  /// The signed distance, interpolated linearly; at least (at most) the band beyond it.
  double distance(const Vec<Dim>& p) const;

  /// Moves p along normals until its distance is at most `level`, to 1 % of the node distance.
  /// False, and p as it was, where the mesh cannot tell: away from the level it was made for, and
  /// where the surface is bent too much.
  bool move_below(Vec<Dim>& p, double level) const;

  /// Volume (area in 2D) inside the shape, within the box.
  double volume() const { return volume_; }

 private:
  static constexpr Index edge_ = 8;  // nodes along the edge of a block
  static constexpr Index edge_y_ = Dim == 3 ? edge_ : 1;
  static constexpr Index block_nodes_ = edge_ * edge_y_ * edge_;
  using Place = std::array<Index, 3>;  // of a node; [1] is 0 in 2D

  struct Node {
    float distance = 0;
    float normal[Dim] = {};    // central differences of the distance
    float gradient[Dim] = {};  // the sums
    float sum = 0;
  };
  /// A distance and its slope at a point.
  struct Tangent {
    Vec<Dim> at, normal;
    double distance;
    double operator()(const Vec<Dim>& p) const { return distance + normal.dot(p - at); }
  };
  // Models of the surface in a cell: none; distances interpolated to second order; or this and
  // more, one of Block::edges: the largest of a few linear distances.
  static constexpr std::int16_t none = -2, smooth = -1;
  struct Block {
    Place first;  // its first node
    std::vector<Node> nodes;
    std::vector<std::int16_t> model;  // of the surface, in the cell above each node
    std::vector<std::vector<Tangent>> edges;
  };
  /// A number for each node of a block and of those around it, x fastest.
  struct Around {
    Index reach, nx, ny;
    std::vector<float> value;

    Index reach_y() const { return Dim == 3 ? reach : 0; }
    Index at(Index k) const {
      return ((k / (edge_ * edge_y_) + reach) * ny + k / edge_ % edge_y_ + reach_y()) * nx +
             k % edge_ + reach;
    }
  };

  LevelSetMesh(const Vec3& lo, const Vec3& hi, double h, double band);
  template <class F>
  void fill(const Shape& shape, F&& distance);
  void find_distances(const Shape& shape);
  void finish();
  template <class F>
  void for_each_stored(F&& f);
  template <class F>
  Around around(const Block& block, Index reach, F&& f) const;
  void set_normals(Block& block) const;
  void sum_outside(Block& block) const;
  void choose_models(Block& block, const Shape& shape, double level) const;
  std::vector<Tangent> tangents(const Place& low) const;

  static Place place(const Block& block, Index k);
  std::int32_t slot(const Place& at) const;
  const Node& node(const Place& at) const;  // one of deep_ where nothing is stored
  Vec3 position(const Place& at) const;
  Place below(const Vec<Dim>& p) const;
  /// Calls f(node, weight, p - its position) for the corners of the cell of p above `low`.
  template <class F>
  void for_each_corner(const Place& low, const Vec<Dim>& p, F&& f) const;
  Tangent blend(const Place& low, const Vec<Dim>& p) const;

  Vec3 lo_, hi_;
  double h_, width_, band_;
  Index blocks_[3];
  Node deep_[2];  // inside and outside, beyond the band
  double volume_ = 0.0;
  std::vector<std::int32_t> slot_;  // block -> stored block, -1 wholly inside, -2 wholly outside
  std::vector<Block> stored_;
};

extern template class LevelSetMesh<2>;
extern template class LevelSetMesh<3>;

}  // namespace sphgeo
