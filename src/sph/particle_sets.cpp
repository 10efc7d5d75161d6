#include "sph/particle_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/error.h"
#include "core/indices_where.h"
#include "core/parallel.h"

namespace sphgeo {

template <int Dim>
ParticleSet<Dim>& ParticleSets<Dim>::add(std::string name, std::string phase, double spacing,
                                         double h, bool moves) {
  sets_.push_back(std::make_unique<ParticleSet<Dim>>(name, std::move(phase), spacing, h));
  for (const FieldSpec* spec : {&fields::id, &fields::part, &fields::position, &fields::velocity})
    sets_.back()->require(*spec);
  moves_[name] = moves;
  lost_[name] = 0;
  return *sets_.back();
}

template <int Dim>
ParticleSet<Dim>* ParticleSets<Dim>::find(const std::string& name) const {
  for (const auto& s : sets_)
    if (s->name() == name) return s.get();
  return nullptr;
}

template <int Dim>
ParticleSet<Dim>& ParticleSets<Dim>::at(const std::string& name) const {
  if (ParticleSet<Dim>* s = find(name)) return *s;
  throw std::logic_error("no particle set " + name);
}

template <int Dim>
double ParticleSets<Dim>::reach() const {
  double h = 0;
  for (const auto& s : sets_) h = std::max(h, s->smoothing_length());
  return 2 * h;
}

template <int Dim>
void ParticleSets<Dim>::set_domain(const Vec<Dim>& lo, const Vec<Dim>& hi) {
  lo_ = lo;
  hi_ = hi;
}

template <int Dim>
void ParticleSets<Dim>::remove_lost(ParticleSet<Dim>& set, OutsideDomain policy, double time) {
  const auto& x = set.vector(fields::position);
  const auto outside = [&](Index i) {
    // Written so that NaN counts as outside.
    return !((x[i].array() >= lo_.array()).all() && (x[i].array() <= hi_.array()).all());
  };
  const double count = ordered_sum(set.size(), [&](Index i) { return outside(i) ? 1.0 : 0.0; });
  if (count == 0) return;
  for (const std::uint32_t i : indices_where(set.size(), outside)) {
    const bool lost = x[i].allFinite();  // a position that is not finite is an error, not a loss
    if (lost && policy != OutsideDomain::stop && set.phase() != "solid") continue;
    const Vec3 at = to_space<Dim>(x[i]);
    throw UnstableError(
        lost ? fmt::format("particle {} of set '{}' left the domain at ({:.4g}, {:.4g}, {:.4g}) m, "
                           "t = {:.6g} s; {}",
                           set.ids()[i], set.name(), at.x(), at.y(), at.z(), time,
                           set.phase() == "solid"
                               ? "a solid cannot lose particles: give a larger numerics.domain_min "
                                 "or domain_max, or something that holds it"
                               : "numerics.outside is 'stop'")
             : fmt::format("the position of particle {} of set '{}' is not finite at t = {:.6g} s",
                           set.ids()[i], set.name(), time),
        {lost ? "lost" : "not_finite", "", set.name(), set.ids()[i], at, time});
  }
  const std::vector<std::uint32_t> keep =
      indices_where(set.size(), [&](Index i) { return !outside(i); });
  lost_[set.name()] += set.size() - static_cast<Index>(keep.size());
  set.permute(keep);
}

template <int Dim>
std::size_t ParticleSets<Dim>::bytes() const {
  std::size_t sum = 0;
  for (const auto& s : sets_) sum += s->bytes();
  return sum;
}

template <int Dim>
void ParticleSets<Dim>::save(StateSink& sink) const {
  sink.put("domain/lo", std::span<const double>(lo_.data(), Dim));
  sink.put("domain/hi", std::span<const double>(hi_.data(), Dim));
  for (const auto& [name, n] : lost_) sink.put_count("lost/" + name, n);
  for (const auto& s : sets_) s->save(sink);
}

template <int Dim>
void ParticleSets<Dim>::load(const StateSource& source) {
  source.get("domain/lo", std::span<double>(lo_.data(), Dim));
  source.get("domain/hi", std::span<double>(hi_.data(), Dim));
  for (auto& [name, n] : lost_) n = source.count("lost/" + name);
  for (auto& s : sets_) s->load(source);
}

template class ParticleSets<2>;
template class ParticleSets<3>;

}  // namespace sphgeo
