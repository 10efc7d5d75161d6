#include "geometry/bvh.h"

namespace sphgeo {

BoxTree::BoxTree(const std::vector<Aabb>& pieces) {
  if (pieces.empty()) return;
  order_.resize(pieces.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(pieces.size());
  build(pieces, 0, static_cast<std::int32_t>(pieces.size()));
}

std::int32_t BoxTree::build(const std::vector<Aabb>& pieces, std::int32_t first,
                            std::int32_t count) {
  constexpr std::int32_t leaf_size = 4;
  Node node;
  Aabb centres;
  for (std::int32_t k = first; k < first + count; ++k) {
    const Aabb& b = pieces[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])];
    node.box.extend(b);
    centres.extend(Vec3(0.5 * (b.lo + b.hi)));
  }
  const auto index = static_cast<std::int32_t>(nodes_.size());
  if (count <= leaf_size) {
    node.first = first;
    node.count = count;
    nodes_.push_back(node);
    return index;
  }
  nodes_.push_back(node);
  int axis = 0;
  (centres.hi - centres.lo).maxCoeff(&axis);
  const std::int32_t half = count / 2;
  // Halving by rank bounds the depth by log2(n) whatever the pieces look like; the index decides
  // ties, so that the tree is the same with every library.
  std::nth_element(order_.begin() + first, order_.begin() + first + half,
                   order_.begin() + first + count, [&](std::int32_t a, std::int32_t b) {
                     const Aabb& x = pieces[static_cast<std::size_t>(a)];
                     const Aabb& y = pieces[static_cast<std::size_t>(b)];
                     const double ca = x.lo[axis] + x.hi[axis], cb = y.lo[axis] + y.hi[axis];
                     return ca < cb || (ca == cb && a < b);
                   });
  const std::int32_t left = build(pieces, first, half);
  const std::int32_t right = build(pieces, first + half, count - half);
  nodes_[static_cast<std::size_t>(index)].first = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  return index;
}

}  // namespace sphgeo
