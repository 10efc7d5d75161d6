#include "sph/variable_sums.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "sph/gather.h"
#include "sph/kernel.h"

namespace sphgeo {

namespace {

// Largest over smallest smoothing length of the targets of a group.
constexpr double group_ratio = 1.12;

// What a particle brings to the sums of its neighbors.
template <int Dim>
struct SummedVolume : RecordType<Dim> {
  static constexpr RecordField<SummedVolume, 0, Dim> position{};
  static constexpr RecordField<SummedVolume, Dim> volume{};  ///< m^Dim
  static constexpr RecordSpec spec{
      "summed_volume", 0, "particles that are relaxed", {{{"volume", volume}}}};
};

// A particle whose sums are taken.
template <int Dim>
struct SummedTarget : RecordType<Dim> {
  static constexpr RecordField<SummedTarget, 0, Dim> position{};
  static constexpr RecordField<SummedTarget, Dim> per_h2{};  ///< 1 / h^2, 1/m2
  static constexpr RecordSpec spec{
      "summed_target", 0, "kernel widths of relaxed particles", {{{"per_h2", per_h2}}}};
};

template <int Dim>
struct DensityAndGradient {
  Kernel<Dim> unit{1.0};

  template <class T>
  struct Sums {
    T density{};
    LaneVec<Dim, T> gradient{};
  };

  template <class T>
  void operator()(Sums<T>& sum, const Record<T, SummedTarget<Dim>>& i,
                  const Record<T, SummedVolume<Dim>>& j, const LaneVec<Dim, T>& r,
                  const T& r2) const {
    const T q2 = r2 * i[SummedTarget<Dim>::per_h2];
    sum.density += unit.w(q2) * j[SummedVolume<Dim>::volume];
    sum.gradient += (unit.dw_over_r(q2) * j[SummedVolume<Dim>::volume]) * r;
  }
};

}  // namespace

template <int Dim>
VariableSums<Dim>::VariableSums(const FixedPoint<Dim>& frame, Index count,
                                std::vector<Index> targets)
    : frame_(frame),
      targets_(std::move(targets)),
      group_(static_cast<std::size_t>(count), -1),
      records_(count, frame) {}

template <int Dim>
bool VariableSums<Dim>::lists_hold(std::span<const Vec<Dim>> r, std::span<const double> h) {
  const auto n = static_cast<Index>(targets_.size());
  const auto target = [&](Index k) {
    return static_cast<std::size_t>(targets_[static_cast<std::size_t>(k)]);
  };
  const auto moved = [&](std::size_t i) { return (r[i] - searched_at_[i]).norm(); };
  const double farthest = block_max(n, [&](Index k) { return moved(target(k)); });
  // Two particles approach each other by both their displacements, and a kernel may have grown.
  const double excess = block_max(n, [&](Index k) {
    const std::size_t i = target(k);
    return moved(i) + farthest + 2 * h[i] - groups_[static_cast<std::size_t>(group_[i])].radius;
  });
  ++age_;
  approach_ = 2 * farthest / static_cast<double>(age_);
  return excess <= 0;
}

template <int Dim>
void VariableSums<Dim>::search(std::span<const Vec<Dim>> r, std::span<const double> h) {
  const auto n = static_cast<Index>(targets_.size());
  const auto h_of = [&](Index k) {
    return h[static_cast<std::size_t>(targets_[static_cast<std::size_t>(k)])];
  };
  const double smallest = block_min(n, h_of), largest = block_max(n, h_of);
  const auto group_of = [&](double length) {
    return static_cast<std::size_t>(std::log(length / smallest) / std::log(group_ratio));
  };
  // A search takes about twice the time of the sums, which grows with the cube of the radius: the
  // sum of both is least for this margin. The first steps are the longest.
  const double reach = 2 * smallest;
  const double margin =
      searches_ == 0 ? 0.2 * reach
                     : std::clamp(std::sqrt(0.7 * approach_ * reach), 0.02 * reach, 0.3 * reach);
  groups_.resize(group_of(largest) + 1);
  for (Group& g : groups_) {
    g.radius = 0;
    g.particle.clear();
  }
  parallel_for(n, [&](Index k) {
    group_[static_cast<std::size_t>(targets_[static_cast<std::size_t>(k)])] =
        static_cast<std::int32_t>(group_of(h_of(k)));
  });
  searched_at_.assign(r.begin(), r.end());
  grid_.build(r, frame_, reach + margin);
  order_.assign(grid_.order().begin(), grid_.order().end());
  grid_.set_sorted();
  for (const std::uint32_t i : order_) {
    if (group_[i] < 0) continue;
    Group& g = groups_[static_cast<std::size_t>(group_[i])];
    g.particle.push_back(i);
    g.radius = std::max(g.radius, 2 * h[i] + margin);
  }
  std::vector<Vec<Dim>> at;
  for (Group& g : groups_) {
    at.clear();
    for (const std::uint32_t i : g.particle) at.push_back(r[i]);
    g.list.template build<Dim>(at, grid_, g.radius, Pairing::across);
    g.records.resize(static_cast<Index>(at.size()), frame_);
  }
  age_ = 0;
  ++searches_;
}

template <int Dim>
void VariableSums<Dim>::compute(std::span<const Vec<Dim>> r, std::span<const double> volume,
                                std::span<const double> h, std::span<double> density,
                                std::span<Vec<Dim>> gradient) {
  if (targets_.empty()) return;
  if (searches_ == 0 || !lists_hold(r, h)) search(r, h);
  using Volume = SummedVolume<Dim>;
  using Target = SummedTarget<Dim>;
  const RecordPacking<Volume, float> sources(records_);
  parallel_for(records_.size(), [&](Index slot) {
    const std::uint32_t j = order_[static_cast<std::size_t>(slot)];
    sources.set_position(slot, r[j]);
    sources[slot].put(Volume::volume, volume[j]);
  });
  for (Group& g : groups_) {
    const RecordPacking<Target, float> targets(g.records);
    parallel_for(g.records.size(), [&](Index t) {
      const std::uint32_t i = g.particle[static_cast<std::size_t>(t)];
      targets.set_position(t, r[i]);
      targets[t].put(Target::per_h2, 1 / (h[i] * h[i]));
    });
    gather<DensityAndGradient<Dim>::template Sums>(
        g.list, with<float>(targets), with<float>(sources), DensityAndGradient<Dim>{},
        [&](Index t, const typename DensityAndGradient<Dim>::template Sums<double>& sum) {
          const std::uint32_t i = g.particle[static_cast<std::size_t>(t)];
          const double per_volume = std::pow(h[i], -Dim);
          density[i] = per_volume * sum.density;
          for (int d = 0; d < Dim; ++d)
            gradient[i][d] = per_volume / (h[i] * h[i]) * sum.gradient[d];
        });
  }
}

template class VariableSums<2>;
template class VariableSums<3>;

}  // namespace sphgeo
