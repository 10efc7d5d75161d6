#pragma once
// A tree of boxes over many small pieces (triangles, terrain cells): finds the nearest piece.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// Binary tree over the boxes of n pieces. Built once, then read by any number of threads.
class BoxTree {
 public:
  struct Node {
    Aabb box;
    std::int32_t first = 0;  ///< leaf: first entry of order(); inner node: left child
    std::int32_t count = 0;  ///< leaf: number of pieces; 0 for an inner node
    std::int32_t right = 0;  ///< inner node: right child
  };

  BoxTree() = default;
  /// `pieces[i]` bounds piece i. The tree depends only on their order and values.
  explicit BoxTree(const std::vector<Aabb>& pieces);

  bool empty() const { return nodes_.empty(); }
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<std::int32_t>& order() const { return order_; }

  /// Calls `visit(piece)`, which returns a squared distance, for every piece that may lie nearer
  /// than the best so far; returns the smallest squared distance (`best2` when none is nearer).
  template <class Visit>
  double nearest(const Vec3& p, double best2, const Visit& visit) const {
    if (nodes_.empty()) return best2;
    std::int32_t stack[128];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(stack[--depth])];
      if (squared_distance(p, node.box) >= best2) continue;
      if (node.count > 0) {
        for (std::int32_t k = node.first; k < node.first + node.count; ++k)
          best2 = std::min(best2, visit(order_[static_cast<std::size_t>(k)]));
        continue;
      }
      const double l = squared_distance(p, nodes_[static_cast<std::size_t>(node.first)].box);
      const double r = squared_distance(p, nodes_[static_cast<std::size_t>(node.right)].box);
      stack[depth++] = l < r ? node.right : node.first;  // the nearer one is visited first
      stack[depth++] = l < r ? node.first : node.right;
    }
    return best2;
  }

  /// Squared distance from a point to a box, 0 inside.
  static double squared_distance(const Vec3& p, const Aabb& box) {
    return (box.lo - p).cwiseMax(p - box.hi).cwiseMax(0.0).squaredNorm();
  }

 private:
  std::int32_t build(const std::vector<Aabb>& pieces, std::int32_t first, std::int32_t count);

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
};

}  // namespace sphgeo
