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
  /// within `band` [m] of the surface.
  LevelSetMesh(const Shape& shape, const Aabb& around, double h, double band);
  /// Of the same shape for a larger smoothing length, with the distances of another mesh.
  LevelSetMesh(const Shape& shape, const LevelSetMesh& finer, double h);

  struct Missing {
    Vec<Dim> gradient = Vec<Dim>::Zero();  ///< 1/m
    double sum = 0.0;
  };
  /// Interpolated at p; zero deep inside.
  Missing missing(const Vec<Dim>& p) const;

  struct Distance {
    double value = 0.0;  ///< m
    Vec<Dim> gradient = Vec<Dim>::Zero();
  };
  /// The signed distance, interpolated linearly and no larger than the band on either side. Where
  /// parts of the shape touch, deep inside, it may be that of a point nearer to the surface. The
  /// gradient has the length 1 where the surface is plane, and less beside its edges.
  Distance distance(const Vec<Dim>& p) const;

  /// Volume (area in 2D) inside the shape, within the box.
  double volume() const { return volume_; }

 private:
  static constexpr Index edge_ = 8;  // nodes along the edge of a block
  static constexpr Index edge_y_ = Dim == 3 ? edge_ : 1;
  static constexpr Index block_nodes_ = edge_ * edge_y_ * edge_;
  using Place = std::array<Index, 3>;  // of a node; [1] is 0 in 2D

  using Sums = Eigen::Array<float, 4, 1>;  // the gradient and, last, the sum
  struct Node {
    Sums sums = Sums::Zero();
    float distance = 0;
  };
  struct Block {
    Place first;  // its first node
    std::vector<Node> nodes;
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
  void sum_outside(Block& block) const;

  static Place place(const Block& block, Index k);
  /// A node; stored: among those of its block, else one that stands for all of the block.
  struct Found {
    const Node* node;
    bool stored;
  };
  Found find(const Place& at) const;
  Vec3 position(const Place& at) const;
  /// Calls f(k, node) for the corners of the cell of p: bit d of k tells the side along axis d.
  /// Returns the place of p in the cell, from 0 to 1.
  template <class F>
  Vec<Dim> for_each_corner(const Vec<Dim>& p, F&& f) const;

  Vec3 lo_, hi_;
  double h_, width_, band_;
  Index blocks_[3];
  Node deep_[2];  // inside and outside, beyond the band
  double volume_ = 0.0;
  std::vector<std::int32_t> slot_;  // block -> stored block, -1 wholly inside, -2 wholly outside
  std::vector<Block> stored_;
};

/// The second sum of Eq. 84 for smoothing lengths between two bounds: background meshes for a few
/// of them, and straight lines between.
template <int Dim>
class MissingSupport {
 public:
  /// Meshes around the box `around` for smoothing lengths from h_low to h_high [m].
  MissingSupport(const Shape& shape, const Aabb& around, double h_low, double h_high);

  /// Sums over the outside of the shape at p for the smoothing length h; zero deep inside.
  typename LevelSetMesh<Dim>::Missing operator()(const Vec<Dim>& p, double h) const;

  /// The finest mesh; its band is as wide as the widest kernel reaches.
  const LevelSetMesh<Dim>& surface() const { return mesh_.front(); }

 private:
  std::vector<double> h_;
  std::vector<LevelSetMesh<Dim>> mesh_;
};

extern template class LevelSetMesh<2>;
extern template class LevelSetMesh<3>;
extern template class MissingSupport<2>;
extern template class MissingSupport<3>;

}  // namespace sphgeo
