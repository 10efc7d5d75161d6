#include "sph/world.h"

#include <fmt/format.h>

#include "core/parallel.h"
#include "deck/expression.h"

namespace sphgeo {
namespace {

template <int Dim>
std::span<const Vec<Dim>> places_of(const ParticleSet<Dim>& set) {
  const auto& x = set.vector(fields::position);
  return {x.data(), static_cast<std::size_t>(x.size())};
}

std::string packed_path(const std::string& set, int axis) {
  return fmt::format("arrangement/{}/{}/packed", set, axis);
}

}  // namespace

template <int Dim>
World<Dim>::World(std::shared_ptr<const Parameters> parameters)
    : parameters_(std::move(parameters)),
      gravity_(to_scene<Dim>(parameters_->gravity)),
      single_(parameters_->numerics.pair_precision == PairPrecision::single),
      frozen_(parameters_->numerics.pair_geometry == PairGeometry::frozen) {}

template <int Dim>
Vec<Dim> World<Dim>::body_acceleration(const Vec<Dim>& at) const {
  if (!parameters_->body_force) return gravity_;
  const VectorFormula& f = *parameters_->body_force;
  const Vec3 place = to_space<Dim>(at);
  return gravity_ + to_scene<Dim>(Vec3(f[0](place, clock.time), f[1](place, clock.time),
                                       f[2](place, clock.time)));
}

template <int Dim>
ParticleSet<Dim>& World<Dim>::add_solids(std::string name, double spacing, double h) {
  ParticleSet<Dim>& set = add_set(std::move(name), "solid", spacing, h, true);
  for (const FieldSpec* spec :
       {&fields::mass, &fields::reference_position, &fields::reference_volume})
    set.require(*spec);
  return set;
}

template <int Dim>
void World<Dim>::set_domain(const Vec<Dim>& lo, const Vec<Dim>& hi) {
  sets_.set_domain(lo, hi);
  neighborhoods_.fit(lo, hi, sets_.reach());
}

template <int Dim>
void World<Dim>::rearrange() {
  ++arrangement_;
  for (auto& s : sets()) {
    const bool moves = sets_.moves(s->name());
    if (!moves && neighborhoods_.has_grid(s->name()) && grid(s->name()).size() == s->size())
      continue;
    if (moves) sets_.remove_lost(*s, parameters_->numerics.outside, clock.time);
    if (s->phase() == "solid") {
      arrange_solids(*s);
      continue;
    }
    sort(*s, places_of(*s));
    if (packed(s->name())) pack_positions(*s);
  }
  neighborhoods_.build_lists(sets_);
}

// Solids are sorted once; the grid is that of the positions they are at.
template <int Dim>
void World<Dim>::arrange_solids(ParticleSet<Dim>& set) {
  if (!neighborhoods_.has_grid(set.name())) {
    neighborhoods_.sort_at_rest(set, parameters_->solids);
    resize_records(set);
  }
  neighborhoods_.place(set, sets_.reach());
}

// By the cells of the positions `at`, then by id; makes room in the records.
template <int Dim>
void World<Dim>::sort(ParticleSet<Dim>& set, std::span<const Vec<Dim>> at) {
  neighborhoods_.sort(set, at, sets_.reach());
  resize_records(set);
}

template <int Dim>
void World<Dim>::resize_records(const ParticleSet<Dim>& set) {
  records_.resize(set.name(), set.size(), neighborhoods_.frame(), single_);
}

template <int Dim>
void World<Dim>::pack_positions(ParticleSet<Dim>& set) {
  const auto& x = set.vector(fields::position);
  with_pair_precision([&](auto number) {
    const auto r = records_.template write<Position<Dim>, decltype(number)>(set.name());
    parallel_for(set.size(), [&](Index i) { r.set_position(i, x[i]); });
  });
}

template <int Dim>
std::size_t World<Dim>::bytes() const {
  return sets_.bytes() + neighborhoods_.bytes() + records_.bytes();
}

template <int Dim>
void World<Dim>::save(StateSink& sink) const {
  clock.save(sink);
  sets_.save(sink);
  ledger_.save(sink);
  pistons_.save(sink);
}

template <int Dim>
void World<Dim>::load(const StateSource& source) {
  clock.load(source);
  sets_.load(source);
  neighborhoods_.fit(domain_lo(), domain_hi(), sets_.reach());
  neighborhoods_.forget_grids();
  ledger_.load(source);
  pistons_.load(source);
}

template <int Dim>
void World<Dim>::save_arrangement(StateSink& sink) const {
  for (const auto& s : sets()) {
    if (!moves(s->name()) || s->phase() == "solid") continue;
    neighborhoods_.save_positions(sink, s->name());
    if (!packed(s->name())) continue;
    const auto put = [&](const auto& r) {
      const auto n = static_cast<std::size_t>(s->size());
      std::vector<typename std::decay_t<decltype(r)>::Stored> stored(n);
      for (int d = 0; d < Dim; ++d) {
        parallel_for(s->size(), [&](Index i) {
          stored[static_cast<std::size_t>(i)] = r.stored_position(i, d);
        });
        sink.put(packed_path(s->name(), d), stored);
      }
    };
    if (single_) put(records_.template array<float>(s->name(), 0));
    else put(records_.template array<double>(s->name(), 0));
  }
}

template <int Dim>
void World<Dim>::load_arrangement(const StateSource& source) {
  ++arrangement_;
  for (auto& s : sets()) {
    if (s->phase() == "solid") {
      arrange_solids(*s);
      continue;
    }
    if (!moves(s->name())) {
      sort(*s, places_of(*s));
      if (packed(s->name())) pack_positions(*s);
      continue;
    }
    // They are sorted: the order stays.
    sort(*s, neighborhoods_.load_positions(source, s->name(), s->size()));
    if (packed(s->name())) load_packed(source, s->name());
  }
  neighborhoods_.rebuild_lists(sets_);
}

template <int Dim>
void World<Dim>::load_packed(const StateSource& source, const std::string& set) {
  const auto get = [&](auto& r) {
    const auto n = static_cast<std::size_t>(this->set(set).size());
    std::vector<typename std::decay_t<decltype(r)>::Stored> stored(n);
    for (int d = 0; d < Dim; ++d) {
      source.get(packed_path(set, d), std::span(stored));
      parallel_for(this->set(set).size(), [&](Index i) {
        r.set_stored_position(i, d, stored[static_cast<std::size_t>(i)]);
      });
    }
  };
  if (single_) get(records_.template array<float>(set, 0));
  else get(records_.template array<double>(set, 0));
}

template class World<2>;
template class World<3>;

}  // namespace sphgeo
