#include "sph/neighborhoods.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/parallel.h"

namespace sphgeo {
namespace {

template <int Dim>
std::span<const Vec<Dim>> span_of(const Field<Vec<Dim>>& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

template <int Dim>
std::span<const Id> ids_of(const ParticleSet<Dim>& set) {
  return {set.ids().data(), static_cast<std::size_t>(set.ids().size())};
}

std::string path_of(const std::string& set, int axis) {
  return fmt::format("arrangement/{}/{}/listed", set, axis);
}

}  // namespace

template <int Dim>
void Neighborhoods<Dim>::require(const std::string& target, const std::string& source) {
  lists_.try_emplace({target, source});
}

template <int Dim>
NeighborList& Neighborhoods<Dim>::list(const std::string& target, const std::string& source) {
  return lists_.at({target, source});
}

template <int Dim>
void Neighborhoods<Dim>::fit(const Vec<Dim>& lo, const Vec<Dim>& hi, double reach) {
  frame_ = FixedPoint<Dim>::fit(lo, hi, reach);
}

template <int Dim>
void Neighborhoods<Dim>::sort(ParticleSet<Dim>& set, std::span<const Vec<Dim>> at, double reach) {
  CellGrid<Dim>& grid = grids_[set.name()];
  grid.build(at, frame_, reach, ids_of(set));
  set.permute(grid.order());
  grid.set_sorted();
}

template <int Dim>
void Neighborhoods<Dim>::sort_at_rest(ParticleSet<Dim>& set, const SolidParameters& solids) {
  CellGrid<Dim> rest;
  const auto& x = set.vector(fields::reference_position);
  rest.build(span_of<Dim>(x), frame_, 2 * set.smoothing_length(), ids_of(set));
  set.permute(rest.order());
  rest.set_sorted();
  const auto list = reference_lists_.find(set.name());
  if (list == reference_lists_.end()) return;
  list->second.template build<Dim>(span_of<Dim>(x), rest, 2 * set.smoothing_length(),
                                   Pairing::within);
  const auto& part = set.tag(fields::part);
  list->second.filter(
      [&](Index i, Index j) { return part[i] == part[j] && !solids[part[i]].rigid(); });
}

template <int Dim>
void Neighborhoods<Dim>::place(const ParticleSet<Dim>& set, double reach) {
  grids_[set.name()].build(span_of<Dim>(set.vector(fields::position)), frame_, reach, ids_of(set));
}

template <int Dim>
void Neighborhoods<Dim>::build_list(const ParticleSets<Dim>& sets, const Key& key,
                                    NeighborList& list, std::span<const Vec<Dim>> at) {
  // Section 3.5: pairs of different sets use the larger smoothing length, so that both see each
  // other.
  const double radius =
      2 * std::max(sets.at(key.first).smoothing_length(), sets.at(key.second).smoothing_length());
  list.template build<Dim>(at, grids_.at(key.second), radius,
                           key.first == key.second ? Pairing::within : Pairing::across);
}

template <int Dim>
void Neighborhoods<Dim>::build_lists(const ParticleSets<Dim>& sets) {
  for (auto& [key, list] : lists_)
    build_list(sets, key, list, span_of<Dim>(sets.at(key.first).vector(fields::position)));
}

template <int Dim>
void Neighborhoods<Dim>::rebuild_lists(const ParticleSets<Dim>& sets) {
  for (auto& [key, list] : lists_) build_list(sets, key, list, arranged_positions(key.first));
}

// The integers that the grid was built from.
template <int Dim>
std::vector<Vec<Dim>> Neighborhoods<Dim>::arranged_positions(const std::string& set) const {
  const CellGrid<Dim>& grid = grids_.at(set);
  std::vector<Vec<Dim>> at(static_cast<std::size_t>(grid.size()));
  parallel_for(grid.size(), [&](Index i) {
    std::int32_t fixed[Dim];
    for (int d = 0; d < Dim; ++d) fixed[d] = grid.slot_coordinate(d)[i];
    at[static_cast<std::size_t>(i)] = frame_.place_of(fixed);
  });
  return at;
}

template <int Dim>
void Neighborhoods<Dim>::save_positions(StateSink& sink, const std::string& set) const {
  const CellGrid<Dim>& grid = grids_.at(set);
  for (int d = 0; d < Dim; ++d)
    sink.put(path_of(set, d), std::span<const std::int32_t>(grid.slot_coordinate(d),
                                                            static_cast<std::size_t>(grid.size())));
}

template <int Dim>
std::vector<Vec<Dim>> Neighborhoods<Dim>::load_positions(const StateSource& source,
                                                         const std::string& set,
                                                         Index count) const {
  const auto n = static_cast<std::size_t>(count);
  std::vector<std::int32_t> fixed[Dim];
  for (int d = 0; d < Dim; ++d) {
    fixed[d].resize(n);
    source.get(path_of(set, d), std::span<std::int32_t>(fixed[d]));
  }
  std::vector<Vec<Dim>> at(n);
  parallel_for(count, [&](Index i) {
    std::int32_t one[Dim];
    for (int d = 0; d < Dim; ++d) one[d] = fixed[d][static_cast<std::size_t>(i)];
    at[static_cast<std::size_t>(i)] = frame_.place_of(one);
  });
  return at;
}

template <int Dim>
std::size_t Neighborhoods<Dim>::bytes() const {
  std::size_t sum = 0;
  for (const auto& [name, g] : grids_) sum += g.bytes();
  for (const auto& [key, l] : lists_) sum += l.bytes();
  for (const auto& [key, l] : reference_lists_) sum += l.bytes();
  for (const auto& [key, w] : reference_weights_) sum += w.bytes();
  return sum;
}

template class Neighborhoods<2>;
template class Neighborhoods<3>;

}  // namespace sphgeo
