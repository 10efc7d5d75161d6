#include "geometry/level_set_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
constexpr std::int32_t wholly_inside = -1, wholly_outside = -2;
}

RelaxKernel::RelaxKernel(double h, int dim)
    : h_(h),
      factor_(dim == 2 ? 7.0 / (4.0 * std::numbers::pi * h * h)
                       : 21.0 / (16.0 * std::numbers::pi * h * h * h)) {}

double RelaxKernel::value(double r) const {
  const double q = r / h_;
  if (q >= 2.0) return 0.0;
  const double a = 1.0 - 0.5 * q;
  return factor_ * a * a * a * a * (2.0 * q + 1.0);
}

double RelaxKernel::slope(double r) const {
  const double q = r / h_;
  if (q >= 2.0) return 0.0;
  const double a = 1.0 - 0.5 * q;
  return -5.0 * factor_ / (h_ * h_) * a * a * a;
}

LevelSetMesh::LevelSetMesh(const Shape& shape, const Aabb& around, double width,
                           const RelaxKernel& kernel, int dim)
    : width_(width), dim_(dim), cell_(dim == 2 ? width * width : width * width * width) {
  const double margin = kernel.support() + 2.0 * width;
  origin_ = around.lo.array() - margin;
  const auto count = [&](int k) {
    return static_cast<Index>(
        std::ceil((around.hi[k] - around.lo[k] + 2.0 * margin) / (width * edge_)));
  };
  blocks_ = {count(0), dim == 3 ? count(1) : 1, count(2)};
  if (dim == 2) origin_.y() = 0.0;
  const Index total = blocks_.x * blocks_.y * blocks_.z;
  slot_.assign(static_cast<std::size_t>(total), wholly_inside);

  // A block is stored when the surface or the kernel's reach around it can touch it.
  const double half = 0.5 * (edge_ - 1) * width;
  const double radius = half * std::sqrt(static_cast<double>(dim)) + width;
  std::vector<double> centre(static_cast<std::size_t>(total));
  parallel_for(total, [&](Index b) {
    const Index bx = b % blocks_.x, by = b / blocks_.x % blocks_.y,
                bz = b / (blocks_.x * blocks_.y);
    Vec3 c = place(bx * edge_, by * edge_, bz * edge_) + Vec3::Constant(half);
    if (dim == 2) c.y() = 0.0;
    centre[static_cast<std::size_t>(b)] = shape.bound(c);
  });
  std::vector<Index> near;
  const Index nodes = dim == 3 ? edge_ * edge_ * edge_ : edge_ * edge_;
  for (Index b = 0; b < total; ++b) {
    const double d = centre[static_cast<std::size_t>(b)];
    auto& slot = slot_[static_cast<std::size_t>(b)];
    if (d < -radius - kernel.support()) {
      volume_ += static_cast<double>(nodes) * cell_;
    } else if (d > radius + kernel.support()) {
      slot = wholly_outside;
    } else {
      slot = static_cast<std::int32_t>(near.size());
      near.push_back(b);
    }
  }
  stored_.resize(near.size());
  parallel_blocks(static_cast<Index>(near.size()), 1, [&](Index begin, Index, Index) {
    const Index b = near[static_cast<std::size_t>(begin)];
    const Index bx = b % blocks_.x, by = b / blocks_.x % blocks_.y,
                bz = b / (blocks_.x * blocks_.y);
    Block& block = stored_[static_cast<std::size_t>(begin)];
    block.distance.resize(static_cast<std::size_t>(nodes));
    for (Index k = 0; k < nodes; ++k)
      block.distance[static_cast<std::size_t>(k)] = static_cast<float>(shape.signed_distance(
          place(bx * edge_ + k % edge_, dim_ == 3 ? by * edge_ + k / edge_ % edge_ : 0,
                bz * edge_ + (dim_ == 3 ? k / (edge_ * edge_) : k / edge_))));
  });
  for (const Block& block : stored_)
    for (const float d : block.distance) volume_ += cell_ * std::clamp(0.5 - d / width_, 0.0, 1.0);
  parallel_blocks(static_cast<Index>(near.size()), 1, [&](Index begin, Index, Index) {
    sum_outside(near[static_cast<std::size_t>(begin)], kernel);
  });
}

Vec3 LevelSetMesh::place(Index x, Index y, Index z) const {
  return origin_ +
         width_ * Vec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
}

const LevelSetMesh::Block* LevelSetMesh::find(Index x, Index y, Index z, std::size_t& local) const {
  const std::int32_t s =
      slot_[static_cast<std::size_t>(block_index(x / edge_, y / edge_, z / edge_))];
  local = static_cast<std::size_t>(dim_ == 3 ? (z % edge_ * edge_ + y % edge_) * edge_ + x % edge_
                                             : z % edge_ * edge_ + x % edge_);
  return s >= 0 ? &stored_[static_cast<std::size_t>(s)] : nullptr;
}

double LevelSetMesh::outside(Index x, Index y, Index z) const {
  const Index ny = dim_ == 3 ? blocks_.y * edge_ : 1;
  if (x < 0 || y < 0 || z < 0 || x >= blocks_.x * edge_ || y >= ny || z >= blocks_.z * edge_)
    return 1.0;
  std::size_t local = 0;
  const Block* block = find(x, y, z, local);
  // The surface cuts the cell of a node; its distance tells by how much, without a jump.
  if (block) return std::clamp(0.5 + block->distance[local] / width_, 0.0, 1.0);
  return slot_[static_cast<std::size_t>(block_index(x / edge_, y / edge_, z / edge_))] ==
                 wholly_outside
             ? 1.0
             : 0.0;
}

void LevelSetMesh::sum_outside(Index b, const RelaxKernel& kernel) {
  Block& block = stored_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(b)])];
  const Index bx = b % blocks_.x, by = b / blocks_.x % blocks_.y, bz = b / (blocks_.x * blocks_.y);
  const Index reach = static_cast<Index>(std::ceil(kernel.support() / width_));
  const Index reach_y = dim_ == 3 ? reach : 0;
  const Index nodes = static_cast<Index>(block.distance.size());
  block.sums.assign(static_cast<std::size_t>(4 * nodes), 0.0f);
  for (Index k = 0; k < nodes; ++k) {
    const double d = block.distance[static_cast<std::size_t>(k)];
    // Particles stay half a spacing inside; nodes beyond the surface serve interpolation only.
    if (d < -kernel.support() - width_ || d > 2.0 * width_) continue;
    const Index x = bx * edge_ + k % edge_, y = dim_ == 3 ? by * edge_ + k / edge_ % edge_ : 0;
    const Index z = bz * edge_ + (dim_ == 3 ? k / (edge_ * edge_) : k / edge_);
    Vec3 gradient = Vec3::Zero();
    double sum = 0.0;
    for (Index dz = -reach; dz <= reach; ++dz)
      for (Index dy = -reach_y; dy <= reach_y; ++dy)
        for (Index dx = -reach; dx <= reach; ++dx) {
          const Vec3 apart = -width_ * Vec3(static_cast<double>(dx), static_cast<double>(dy),
                                            static_cast<double>(dz));
          const double r = apart.norm();
          if (r >= kernel.support()) continue;
          const double v = outside(x + dx, y + dy, z + dz) * cell_;
          if (v == 0.0) continue;
          gradient += kernel.slope(r) * v * apart;
          sum += kernel.value(r) * v;
        }
    for (int c = 0; c < 3; ++c)
      block.sums[static_cast<std::size_t>(4 * k + c)] = static_cast<float>(gradient[c]);
    block.sums[static_cast<std::size_t>(4 * k + 3)] = static_cast<float>(sum);
  }
}

LevelSetMesh::Missing LevelSetMesh::missing(const Vec3& p) const {
  Missing out;
  const Vec3 at = (p - origin_) / width_;
  const Index x = static_cast<Index>(std::floor(at.x())),
              z = static_cast<Index>(std::floor(at.z()));
  const Index y = dim_ == 3 ? static_cast<Index>(std::floor(at.y())) : 0;
  const Vec3 part{at.x() - static_cast<double>(x),
                  dim_ == 3 ? at.y() - static_cast<double>(y) : 0.0,
                  at.z() - static_cast<double>(z)};
  const Index ny = dim_ == 3 ? blocks_.y * edge_ - 1 : 1;
  if (x < 0 || y < 0 || z < 0 || x + 1 >= blocks_.x * edge_ || y >= ny ||
      z + 1 >= blocks_.z * edge_)
    return out;
  for (int k = 0; k < 8; ++k) {
    const int i = k & 1, j = k >> 1 & 1, l = k >> 2;
    if (dim_ == 2 && j == 1) continue;
    const double w = (i ? part.x() : 1.0 - part.x()) * (j ? part.y() : 1.0 - part.y()) *
                     (l ? part.z() : 1.0 - part.z());
    std::size_t local = 0;
    const Block* block = find(x + i, y + j, z + l, local);
    if (!block) continue;
    const float* s = &block->sums[4 * local];
    out.gradient += w * Vec3(s[0], s[1], s[2]);
    out.sum += w * s[3];
  }
  return out;
}

}  // namespace sphgeo
