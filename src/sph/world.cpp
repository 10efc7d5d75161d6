#include "sph/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/error.h"
#include "core/indices_where.h"
#include "core/parallel.h"

namespace sphgeo {
namespace {

template <int Dim>
std::span<const Vec<Dim>> places_of(const ParticleSet<Dim>& set) {
  const auto& x = set.vector(fields::position);
  return {x.data(), static_cast<std::size_t>(x.size())};
}

template <int Dim>
std::span<const Id> ids_of(const ParticleSet<Dim>& set) {
  return {set.ids().data(), static_cast<std::size_t>(set.ids().size())};
}

}  // namespace

template <int Dim>
World<Dim>::World(const Model& model)
    : model_(model),
      gravity_(to_scene<Dim>(model.gravity)),
      single_(model.numerics.pair_precision == "single"),
      frozen_(model.numerics.pair_geometry == "frozen") {}

template <int Dim>
Vec<Dim> World<Dim>::pull(const Vec<Dim>& at) const {
  if (!model_.body_force) return gravity_;
  const auto& f = *model_.body_force;
  const Vec3 place = to_space<Dim>(at);
  return gravity_ + to_scene<Dim>(Vec3(f[0](place, clock.time), f[1](place, clock.time),
                                       f[2](place, clock.time)));
}

template <int Dim>
ParticleSet<Dim>& World<Dim>::add_set(std::string name, std::string phase, double spacing, double h,
                                      bool moves) {
  sets_.push_back(std::make_unique<ParticleSet<Dim>>(name, std::move(phase), spacing, h));
  for (const FieldSpec* spec : {&fields::id, &fields::part, &fields::position, &fields::velocity})
    sets_.back()->require(*spec);
  moves_[name] = moves;
  lost_[name] = 0;
  return *sets_.back();
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
ParticleSet<Dim>* World<Dim>::find(const std::string& name) const {
  for (const auto& s : sets_)
    if (s->name() == name) return s.get();
  return nullptr;
}

template <int Dim>
ParticleSet<Dim>& World<Dim>::set(const std::string& name) const {
  if (ParticleSet<Dim>* s = find(name)) return *s;
  throw std::logic_error("no particle set " + name);
}

template <int Dim>
void World<Dim>::require_list(const std::string& target, const std::string& source) {
  lists_.try_emplace({target, source});
}

template <int Dim>
NeighborList& World<Dim>::list(const std::string& target, const std::string& source) {
  return lists_.at({target, source});
}

template <int Dim>
void World<Dim>::set_domain(const Vec<Dim>& lo, const Vec<Dim>& hi) {
  lo_ = lo;
  hi_ = hi;
  frame_ = FixedPoint<Dim>::fit(lo, hi, reach());
}

template <int Dim>
double World<Dim>::reach() const {
  double h = 0;
  for (const auto& s : sets_) h = std::max(h, s->smoothing_length());
  return 2 * h;
}

template <int Dim>
void World<Dim>::remove_lost(ParticleSet<Dim>& set) {
  const auto& x = set.vector(fields::position);
  const auto outside = [&](Index i) {
    // Written so that NaN counts as outside.
    return !((x[i].array() >= lo_.array()).all() && (x[i].array() <= hi_.array()).all());
  };
  const double count = ordered_sum(set.size(), [&](Index i) { return outside(i) ? 1.0 : 0.0; });
  if (count == 0) return;
  for (const std::uint32_t i : indices_where(set.size(), outside)) {
    const bool lost = x[i].allFinite();  // what has no place at all has not left: it is broken
    if (lost && model_.numerics.outside != "stop" && set.phase() != "solid") continue;
    const Vec3 at = to_space<Dim>(x[i]);
    throw UnstableError(
        lost ? fmt::format("particle {} of set '{}' left the domain at ({:.4g}, {:.4g}, {:.4g}) m, "
                           "t = {:.6g} s; {}",
                           set.ids()[i], set.name(), at.x(), at.y(), at.z(), clock.time,
                           set.phase() == "solid"
                               ? "a solid cannot lose particles: give a larger numerics.domain_min "
                                 "or domain_max, or something that holds it"
                               : "numerics.outside is 'stop'")
             : fmt::format("the position of particle {} of set '{}' is not finite at t = {:.6g} s",
                           set.ids()[i], set.name(), clock.time),
        {lost ? "lost" : "not_finite", "", set.name(), set.ids()[i], at, clock.time});
  }
  const std::vector<std::uint32_t> keep =
      indices_where(set.size(), [&](Index i) { return !outside(i); });
  lost_[set.name()] += set.size() - static_cast<Index>(keep.size());
  set.permute(keep);
}

template <int Dim>
void World<Dim>::rearrange() {
  ++arrangement_;
  for (auto& s : sets_) {
    const bool moves = moves_[s->name()];
    if (!moves && grids_[s->name()].size() == s->size()) continue;
    if (moves) remove_lost(*s);
    if (s->phase() == "solid") {
      arrange_solids(*s);
      continue;
    }
    sort(*s, places_of(*s));
    if (records_.contains({s->name(), 0})) pack_positions(*s);
  }
  for (auto& [key, list] : lists_) build_list(key, list, places_of(set(key.first)));
}

template <int Dim>
bool World<Dim>::is_rigid(std::int32_t part) const {
  const MaterialSpec* material =
      model_.material(model_.bodies[static_cast<std::size_t>(part)].material);
  return material && material->type == "rigid";
}

// Solids are sorted once, by their reference positions, which also find their neighbors for good;
// the grid is that of the places they are at.
template <int Dim>
void World<Dim>::arrange_solids(ParticleSet<Dim>& set) {
  const auto list = reference_lists_.find(set.name());
  const bool first = !grids_.contains(set.name());
  if (first) {
    CellGrid<Dim> rest;
    const auto& x = set.vector(fields::reference_position);
    const auto places = [&] {
      return std::span<const Vec<Dim>>(x.data(), static_cast<std::size_t>(x.size()));
    };
    rest.build(places(), frame_, 2 * set.smoothing_length(), ids_of(set));
    set.permute(rest.order());
    rest.set_sorted();
    for (auto& [key, record] : records_) {
      if (key.first != set.name()) continue;
      if (single_) record.single.resize(set.size(), frame_);
      else record.full.resize(set.size(), frame_);
    }
    if (list != reference_lists_.end()) {
      list->second.template build<Dim>(places(), rest, 2 * set.smoothing_length(), Pairing::within);
      const auto& part = set.tag(fields::part);
      list->second.filter(
          [&](Index i, Index j) { return part[i] == part[j] && !is_rigid(part[i]); });
    }
  }
  grids_[set.name()].build(places_of(set), frame_, reach(), ids_of(set));
}

// By the cells of the places `at`, then by id; makes room in the records.
template <int Dim>
void World<Dim>::sort(ParticleSet<Dim>& set, std::span<const Vec<Dim>> at) {
  CellGrid<Dim>& grid = grids_[set.name()];
  grid.build(at, frame_, reach(), ids_of(set));
  set.permute(grid.order());
  grid.set_sorted();
  for (auto& [key, record] : records_) {
    if (key.first != set.name()) continue;
    if (single_) record.single.resize(set.size(), frame_);
    else record.full.resize(set.size(), frame_);
  }
}

template <int Dim>
void World<Dim>::build_list(const std::pair<std::string, std::string>& key, NeighborList& list,
                            std::span<const Vec<Dim>> at) {
  // Section 3.5: pairs of different sets use the larger smoothing length, so that both see each
  // other.
  const double radius =
      2 * std::max(set(key.first).smoothing_length(), set(key.second).smoothing_length());
  list.template build<Dim>(at, grids_.at(key.second), radius,
                           key.first == key.second ? Pairing::within : Pairing::across);
}

template <int Dim>
void World<Dim>::pack_positions(ParticleSet<Dim>& set) {
  const auto& x = set.vector(fields::position);
  with_pair_precision([&](auto number) {
    auto& r = records(set.name()).template get<decltype(number)>();
    parallel_for(set.size(), [&](Index i) { r.set_position(i, x[i]); });
  });
}

template <int Dim>
std::size_t World<Dim>::bytes() const {
  std::size_t sum = 0;
  for (const auto& s : sets_) sum += s->bytes();
  for (const auto& [name, r] : records_) sum += r.single.bytes() + r.full.bytes();
  for (const auto& [name, g] : grids_) sum += g.bytes();
  for (const auto& [key, l] : lists_) sum += l.bytes();
  for (const auto& [key, l] : reference_lists_) sum += l.bytes();
  for (const auto& [key, w] : reference_weights_) sum += w.bytes();
  return sum;
}

template <int Dim>
void World<Dim>::save(StateSink& sink) const {
  sink.put_number("clock/time", clock.time);
  sink.put_number("clock/dt_acoustic", clock.dt_acoustic);
  sink.put_number("clock/dt_advection", clock.dt_advection);
  sink.put_count("clock/advection_steps", clock.advection_steps);
  sink.put_count("clock/acoustic_steps", clock.acoustic_steps);
  sink.put_count("clock/solid_steps", clock.solid_steps);
  sink.put("domain/lo", std::span<const double>(lo_.data(), Dim));
  sink.put("domain/hi", std::span<const double>(hi_.data(), Dim));
  for (const auto& [name, n] : lost_) sink.put_count("lost/" + name, n);
  for (const auto& [name, number] : kept_) sink.put_number("kept/" + name, number);
  for (const auto& [name, book] : exchanged_) {
    const std::string at = "exchanged/" + name + "/";
    sink.put_number(at + "entered", book.entered);
    sink.put_number(at + "left", book.left);
    sink.put_number(at + "mass", book.mass);
    sink.put(at + "momentum", std::span<const double>(book.momentum.data(), Dim));
    sink.put_number(at + "energy", book.energy);
  }
  for (const auto& s : sets_) s->save(sink);
}

template <int Dim>
void World<Dim>::load(const StateSource& source) {
  clock.time = source.number("clock/time");
  clock.dt_acoustic = source.number("clock/dt_acoustic");
  clock.dt_advection = source.number("clock/dt_advection");
  clock.advection_steps = source.count("clock/advection_steps");
  clock.acoustic_steps = source.count("clock/acoustic_steps");
  clock.solid_steps = source.count("clock/solid_steps");
  Vec<Dim> lo, hi;
  source.get("domain/lo", std::span<double>(lo.data(), Dim));
  source.get("domain/hi", std::span<double>(hi.data(), Dim));
  set_domain(lo, hi);
  for (auto& [name, n] : lost_) n = source.count("lost/" + name);
  for (auto& [name, number] : kept_) number = source.number("kept/" + name);
  for (auto& [name, book] : exchanged_) {
    const std::string at = "exchanged/" + name + "/";
    book.entered = source.number(at + "entered");
    book.left = source.number(at + "left");
    book.mass = source.number(at + "mass");
    source.get(at + "momentum", std::span<double>(book.momentum.data(), Dim));
    book.energy = source.number(at + "energy");
  }
  for (auto& s : sets_) s->load(source);
  grids_.clear();  // also those of sets at rest are to be built anew
}

// The integers that the grid was built from.
template <int Dim>
std::vector<Vec<Dim>> World<Dim>::arranged_places(const std::string& set) const {
  const CellGrid<Dim>& grid = grids_.at(set);
  std::vector<Vec<Dim>> at(static_cast<std::size_t>(grid.size()));
  parallel_for(grid.size(), [&](Index i) {
    std::int32_t fixed[Dim];
    for (int d = 0; d < Dim; ++d) fixed[d] = grid.place_coordinate(d)[i];
    at[static_cast<std::size_t>(i)] = frame_.place_of(fixed);
  });
  return at;
}

template <int Dim>
void World<Dim>::save_arrangement(StateSink& sink) const {
  for (const auto& s : sets_) {
    if (!moves_.at(s->name()) || s->phase() == "solid") continue;
    const auto n = static_cast<std::size_t>(s->size());
    const CellGrid<Dim>& grid = grids_.at(s->name());
    const auto records = records_.find({s->name(), 0});
    for (int d = 0; d < Dim; ++d) {
      const std::string at = fmt::format("arrangement/{}/{}/", s->name(), d);
      sink.put(at + "listed", std::span<const std::int32_t>(grid.place_coordinate(d), n));
      if (records == records_.end()) continue;
      const auto put = [&](const auto& r) {
        std::vector<typename std::decay_t<decltype(r)>::Stored> stored(n);
        parallel_for(s->size(), [&](Index i) {
          stored[static_cast<std::size_t>(i)] = r.stored_position(i, d);
        });
        sink.put(at + "packed", stored);
      };
      if (single_) put(records->second.single);
      else put(records->second.full);
    }
  }
}

template <int Dim>
void World<Dim>::load_arrangement(const StateSource& source) {
  ++arrangement_;
  for (auto& s : sets_) {
    const auto n = static_cast<std::size_t>(s->size());
    const bool packed = records_.contains({s->name(), 0});
    if (s->phase() == "solid") {
      arrange_solids(*s);
      continue;
    }
    if (!moves_[s->name()]) {
      sort(*s, places_of(*s));
      if (packed) pack_positions(*s);
      continue;
    }
    std::vector<Vec<Dim>> places(n);
    std::vector<std::int32_t> fixed[Dim];
    for (int d = 0; d < Dim; ++d) {
      fixed[d].resize(n);
      source.get(fmt::format("arrangement/{}/{}/listed", s->name(), d),
                 std::span<std::int32_t>(fixed[d]));
    }
    parallel_for(s->size(), [&](Index i) {
      std::int32_t at[Dim];
      for (int d = 0; d < Dim; ++d) at[d] = fixed[d][static_cast<std::size_t>(i)];
      places[static_cast<std::size_t>(i)] = frame_.place_of(at);
    });
    sort(*s, places);  // they are sorted: nobody changes place
    if (!packed) continue;
    const auto get = [&](auto& r) {
      std::vector<typename std::decay_t<decltype(r)>::Stored> stored(n);
      for (int d = 0; d < Dim; ++d) {
        source.get(fmt::format("arrangement/{}/{}/packed", s->name(), d), std::span(stored));
        parallel_for(s->size(), [&](Index i) {
          r.set_stored_position(i, d, stored[static_cast<std::size_t>(i)]);
        });
      }
    };
    RecordPair<Dim>& records = records_.at({s->name(), 0});
    if (single_) get(records.single);
    else get(records.full);
  }
  for (auto& [key, list] : lists_) build_list(key, list, arranged_places(key.first));
}

template class World<2>;
template class World<3>;

}  // namespace sphgeo
