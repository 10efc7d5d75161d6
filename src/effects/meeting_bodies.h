#pragma once
// Which interface particles of solids may come to touch another solid.

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "core/indices_where.h"
#include "particles/field.h"
#include "sph/parameters.h"

namespace sphgeo {

/// The box of the particles of each body.
template <int Dim>
std::vector<Eigen::AlignedBox<double, Dim>> body_boxes(std::size_t bodies,
                                                       const Field<std::int32_t>& part,
                                                       std::span<const Vec<Dim>> x) {
  using Box = Eigen::AlignedBox<double, Dim>;
  constexpr int large_block = 16 * block_size;
  const auto n = static_cast<Index>(x.size());
  std::vector<std::vector<Box>> parts(
      static_cast<std::size_t>((n + large_block - 1) / large_block));
  parallel_blocks(n, large_block, [&](Index begin, Index end, Index b) {
    std::vector<Box>& box = parts[static_cast<std::size_t>(b)];
    box.resize(bodies);
    for (Index k = begin; k < end; ++k)
      box[static_cast<std::size_t>(part[k])].extend(x[static_cast<std::size_t>(k)]);
  });
  std::vector<Box> all(bodies);
  for (const std::vector<Box>& box : parts)
    for (std::size_t b = 0; b < bodies; ++b) all[b].extend(box[b]);
  return all;
}

/// The particles, rising, of bodies whose boxes come within `radius` (m) of each other or of
/// themselves, in the part of the box where they do.
template <int Dim>
std::vector<std::uint32_t> meeting_particles(const SolidParameters& solids,
                                             const Field<std::int32_t>& part,
                                             std::span<const Vec<Dim>> x, double radius) {
  const auto box = body_boxes<Dim>(solids.of.size(), part, x);
  auto meeting = box;
  for (auto& m : meeting) m.setEmpty();
  for (std::size_t a = 0; a < box.size(); ++a)
    for (std::size_t b = 0; b < box.size(); ++b) {
      if (a == b && !solids.of[a].self_contact) continue;
      if (box[a].isEmpty() || box[b].isEmpty()) continue;
      const Vec<Dim> margin = Vec<Dim>::Constant(radius);
      const Eigen::AlignedBox<double, Dim> near_a(box[a].min() - margin, box[a].max() + margin),
          near_b(box[b].min() - margin, box[b].max() + margin);
      const auto common = near_a.intersection(near_b);
      if (!common.isEmpty()) meeting[a].extend(common);
    }
  return indices_where(static_cast<Index>(x.size()), [&](Index k) {
    return meeting[static_cast<std::size_t>(part[k])].contains(x[static_cast<std::size_t>(k)]);
  });
}

}  // namespace sphgeo
