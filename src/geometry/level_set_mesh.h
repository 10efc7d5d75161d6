#pragma once
// The background mesh of level-set-guided relaxation: what the kernel misses beyond the surface.

#include <unordered_map>
#include <vector>

#include "deck/interfaces.h"

namespace sphgeo {

/// Wendland C2 with support 2 h, in 2D or 3D.
class RelaxKernel {
 public:
  RelaxKernel(double h, int dim);
  double support() const { return 2.0 * h_; }
  double h() const { return h_; }
  double value(double r) const;
  /// dW/dr divided by r, finite at r = 0: gradient = slope(r) * (r_i - r_j).
  double slope(double r) const;

 private:
  double h_;
  double factor_;
};

/// Signed distances on a mesh in a band around the surface, and at each of its nodes the kernel
/// sums over the outside, sum_l grad W V_l and sum_l W V_l with zeta_l > 0 (second sum of Eq. 84).
/// They depend on the shape alone, so they are summed once and interpolated for the particles.
class LevelSetMesh {
 public:
  /// `width` is the node distance, m.
  LevelSetMesh(const Shape& shape, const Aabb& around, double width, const RelaxKernel& kernel,
               int dim);

  struct Missing {
    Vec3 gradient = Vec3::Zero();  ///< 1/m
    double sum = 0.0;
  };
  /// Interpolated at p; zero deep inside.
  Missing missing(const Vec3& p) const;
  /// Volume (area in 2D) inside the shape.
  double volume() const { return volume_; }

 private:
  static constexpr int edge_ = 8;  // nodes along the edge of a block
  struct Block {
    std::vector<float> distance;  // at its nodes
    std::vector<float> sums;      // 3 gradient components and the sum, where they are not all zero
  };
  struct Node {
    Index x, y, z;
  };

  Index block_index(Index bx, Index by, Index bz) const {
    return (bz * blocks_.y + by) * blocks_.x + bx;
  }
  Vec3 place(Index x, Index y, Index z) const;
  /// Share of the node's cell that lies outside the surface.
  double outside(Index x, Index y, Index z) const;
  const Block* find(Index x, Index y, Index z, std::size_t& local) const;
  void sum_outside(Index block, const RelaxKernel& kernel);

  Vec3 origin_;
  double width_;
  int dim_;
  Node blocks_{};
  double cell_;  // volume of a node's cell
  double volume_ = 0.0;
  std::vector<std::int32_t> slot_;  // block -> stored block, -1 wholly inside, -2 wholly outside
  std::vector<Block> stored_;
};

}  // namespace sphgeo
