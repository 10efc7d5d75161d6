#include "solve/guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "core/stopwatch.h"

namespace sphgeo {
namespace {

constexpr int turns_between_slow_checks = 16;
// A step this much shorter than the longest one so far: the run would never end.
constexpr double collapsed = 1e-4;

/// Smallest and largest of a block of values, and whether one of them is not finite.
struct Extremes {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool odd = false;
  Extremes() = default;
  // Without a branch or a dependence from one value to the next, so that it vectorizes; 0 v is 0
  // for every number only.
  explicit Extremes(std::span<const double> values) {
    double least = low, most = high, zero = 0;
#pragma omp simd reduction(min : least) reduction(max : most) reduction(+ : zero)
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double v = values[k];
      least = v < least ? v : least;
      most = v > most ? v : most;
      zero += 0.0 * v;
    }
    low = least;
    high = most;
    odd = zero != 0;
  }
  void take(const Extremes& e) {
    low = std::min(low, e.low);
    high = std::max(high, e.high);
    odd |= e.odd;
  }
};

}  // namespace

template <int Dim>
Guard<Dim>::Guard(const World<Dim>& world, const Plan<Dim>& plan)
    : world_(world),
      plan_(plan),
      bounds_(plan.bounds()),
      seen_(bounds_.size(),
            {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
  for (const auto& s : world.sets()) initial_[s->name()] = s->size();
}

template <int Dim>
void Guard<Dim>::before_step(const StepLimits& limits, double dt) {
  check_speed(limits);
  largest_dt_ = std::max(largest_dt_, dt);
  if (!(dt > collapsed * largest_dt_) || !(world_.clock.time + dt > world_.clock.time))
    stop_collapsed("acoustic", dt, largest_dt_, limits);
  // As many solid steps as it takes go into an acoustic one: without this, a force without bound
  // would never let go of it.
  if (limits.solid == std::numeric_limits<double>::infinity()) return;
  if (std::isfinite(limits.solid)) largest_solid_ = std::max(largest_solid_, limits.solid);
  if (!(limits.solid > collapsed * largest_solid_))
    stop_collapsed("solid", limits.solid, largest_solid_, limits);
}

template <int Dim>
void Guard<Dim>::stop_collapsed(const char* which, double dt, double before,
                                const StepLimits& limits) {
  check_fields(true);  // names the field that went wrong, if one did
  throw UnstableError(
      fmt::format("the {} step collapsed to {:.3g} s at t = {:.6g} s, from {:.3g} s before; the "
                  "fastest particle "
                  "of set '{}' moves at {:.3g} times the speed of sound",
                  which, dt, world_.clock.time, before, limits.fastest, limits.mach),
      {"step", "", limits.fastest, {}, {}, world_.clock.time});
}

template <int Dim>
void Guard<Dim>::check_speed(const StepLimits& limits) {
  if (limits.mach < 1) {
    largest_mach_ = std::max(largest_mach_, limits.mach);
    if (limits.water_mach > water_mach_) {
      water_mach_ = limits.water_mach;
      water_mach_time_ = world_.clock.time;
    }
    return;
  }
  const ParticleSet<Dim>& set = world_.set(limits.fastest);
  const auto& v = set.vector(fields::velocity);
  Index fastest = 0, odd = 0, first_odd = -1;
  for (Index i = 0; i < set.size(); ++i) {
    if (!v[i].allFinite()) {
      if (odd++ == 0) first_odd = i;
    } else if (!v[fastest].allFinite() || v[i].squaredNorm() > v[fastest].squaredNorm()) {
      fastest = i;
    }
  }
  if (odd > 0) check_fields(true);  // names the field that went wrong first, if another one did
  if (odd > 0)
    stop("not_finite", set, fields::velocity, first_odd,
         fmt::format("the velocity of {} particle{} is not finite, first of", odd,
                     odd == 1 ? "" : "s"),
         "");
  stop("speed", set, fields::velocity, fastest,
       fmt::format("with {:.4g} m/s, {:.3g} times its speed of sound, the fastest is",
                   v[fastest].norm(), limits.mach),
       "a larger sound_speed or max_speed of the material, or a start closer to equilibrium, may "
       "help");
}

template <int Dim>
void Guard<Dim>::after_advection() {
  const Stopwatch watch(spent_);
  ++calls_;
  const bool slow = calls_ % turns_between_slow_checks == 1;
  check_fields(slow);
  check_bounds(true);
  if (slow) count_penetrations();
  check_lost();
}

template <int Dim>
void Guard<Dim>::check_all() {
  const Stopwatch watch(spent_);
  check_speed(plan_.limits());
  check_fields(true);
  check_bounds(
      false);  // extremes belong to whole steps: where a run is saved must not show in them
}

// In the order in which a step uses them: the masses, what was there at its start, then the
// results.
template <int Dim>
void Guard<Dim>::check_fields(bool at_rest_too) {
  for (const Lifetime lifetime : {Lifetime::reference, Lifetime::state})
    for (const auto& set : world_.sets())
      for (const auto& [name, field] : set->fields()) {
        const FieldSpec& spec = field->spec();
        if (spec.lifetime != lifetime || (!at_rest_too && !world_.moves(set->name()))) continue;
        if (const Index i = field->first_not_finite(); i >= 0)
          stop("not_finite", *set, spec, i, fmt::format("the {} is not finite at", name), "");
      }
}

template <int Dim>
void Guard<Dim>::check_bounds(bool note) {
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    const FieldBound& bound = bounds_[k];
    const ParticleSet<Dim>& set = world_.set(bound.set);
    const auto& values = set.scalar(*bound.field);
    std::vector<Extremes> parts(
        static_cast<std::size_t>((set.size() + block_size - 1) / block_size));
    parallel_blocks(set.size(), block_size, [&](Index begin, Index end, Index b) {
      parts[static_cast<std::size_t>(b)] =
          Extremes({values.data() + begin, static_cast<std::size_t>(end - begin)});
    });
    Extremes all;
    for (const Extremes& part : parts) all.take(part);
    if (set.size() == 0) continue;
    if (note) seen_[k] = {std::min(seen_[k].first, all.low), std::max(seen_[k].second, all.high)};
    if (!all.odd && all.low >= bound.low && all.high <= bound.high) continue;
    for (Index i = 0; i < set.size(); ++i)
      if (!(values[i] >= bound.low && values[i] <= bound.high))
        stop(bound.field->name, set, *bound.field, i,
             fmt::format("the {} of {:.5g} {} is outside of [{:.5g}, {:.5g}] at", bound.field->name,
                         values[i], bound.field->unit.symbol, bound.low, bound.high),
             values[i] < bound.low ? bound.cause_below : bound.cause_above);
  }
}

template <int Dim>
void Guard<Dim>::check_lost() {
  const double budget = world_.parameters().numerics.max_lost_fraction;
  for (const auto& [name, lost] : world_.lost()) {
    const auto inside = in_walls_.find(name);
    const Index stuck = inside == in_walls_.end() ? 0 : inside->second;
    // With inlets there are more than at the start.
    const Index all = std::max(initial_.at(name), world_.set(name).size() + lost);
    if (static_cast<double>(lost + stuck) <= budget * static_cast<double>(all)) continue;
    throw UnstableError(
        fmt::format("of {} particles of set '{}', {} have left the domain and {} sit inside a wall "
                    "at t = {:.6g} s, more than the budget of {:.3g} % "
                    "(numerics.max_lost_fraction); look for a hole in the boundaries, a domain "
                    "that is too small, or a wall that moves too fast",
                    all, name, lost, stuck, world_.clock.time, 100 * budget),
        {stuck > lost ? "penetration" : "lost", "", name, {}, {}, world_.clock.time});
  }
}

// A particle is inside a wall when it lies behind the particles of the wall's first layer: more
// than half a spacing below the surface. What is clamped may be there: it does not move.
template <int Dim>
void Guard<Dim>::count_penetrations() {
  const ParticleSet<Dim>* walls = world_.find("walls");
  if (!walls) return;
  const auto& y = walls->vector(fields::position);
  const auto& normal = walls->vector(fields::normal);
  for (const auto& [key, list] : world_.lists()) {
    if (key.second != "walls" || key.first == "walls") continue;
    const ParticleSet<Dim>& set = world_.set(key.first);
    const auto& x = set.vector(fields::position);
    const bool interface = key.first == "interface";
    if (interface) interface_.update(world_);
    const double near = walls->spacing() * walls->spacing();
    const auto blocks = list.blocks();
    std::vector<Index> inside(blocks.size(), 0);
    parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
      const auto& block = blocks[static_cast<std::size_t>(b)];
      for (std::size_t k = 0; k < block.size(); ++k) {
        const Index i = block.targets[k];
        if (interface && interface_.at(i).of->clamp[interface_.at(i).i] >= 0) continue;
        double nearest = near;
        bool behind = false;
        for (std::uint32_t e = 0; e < block.count[k]; ++e) {
          const auto j = static_cast<Index>(block.entries[block.begin[k] + e] / 8);
          const Vec<Dim> r = x[i] - y[j];
          if (const double r2 = r.squaredNorm(); r2 < nearest) {
            nearest = r2;
            behind = r.dot(normal[j]) < 0;
          }
        }
        inside[static_cast<std::size_t>(b)] += behind ? 1 : 0;
      }
    });
    Index sum = 0;
    for (const Index n : inside) sum += n;
    in_walls_[key.first] = sum;
  }
}

/// The first effect of a step that sets the field; else the last that changes it.
template <int Dim>
std::string Guard<Dim>::writer_of(const std::string& set, const FieldSpec& field) const {
  std::string name;
  for (const auto& e : plan_.effects())
    for (const FieldUse& use : e.needs.fields)
      if (use.set == set && use.field == &field && use.access != Access::read &&
          e.info.stage != Stage::observe) {
        if (use.access == Access::write) return e.info.name;
        name = e.info.name;
      }
  return name;
}

/// The nearest wall particle that a particle lies behind, or -1: then it is inside of that wall.
template <int Dim>
Index Guard<Dim>::wall_before(const ParticleSet<Dim>& set, Index i) const {
  const ParticleSet<Dim>* walls = world_.find("walls");
  if (!walls) return -1;
  const Vec<Dim> at = set.vector(fields::position)[i];
  const auto& y = walls->vector(fields::position);
  const auto& normal = walls->vector(fields::normal);
  const double dp = walls->spacing();
  double nearest = 1.5 * dp;
  Index before = -1;
  for (Index j = 0; j < walls->size(); ++j) {
    const Vec<Dim> r = at - y[j];
    if (const double d = r.norm(); d < nearest && r.dot(normal[j]) < -0.25 * dp) {
      nearest = d;
      before = j;
    }
  }
  return before;
}

/// Where in the deck to look.
template <int Dim>
std::string Guard<Dim>::suspect(const ParticleSet<Dim>& set, Index i,
                                const std::string& look_for) const {
  const Parameters& parameters = world_.parameters();
  const auto part = static_cast<std::size_t>(set.tag(fields::part)[i]);
  const bool wall = set.name() == "walls";
  const std::vector<Origin>& origins = wall ? parameters.boundaries : parameters.bodies;
  std::string out = part < origins.size()
                        ? fmt::format("; it belongs to {} '{}' ({})", wall ? "boundary" : "body",
                                      origins[part].name, origins[part].location)
                        : "; it has entered through a boundary";
  if (parameters.body_force &&
      !world_.body_acceleration(set.vector(fields::position)[i]).allFinite()) {
    out += "; body_force is not finite there (" + parameters.body_force_location + ")";
  } else if (const Index wall_particle = set.name() == "walls" ? -1 : wall_before(set, i);
             wall_particle >= 0) {
    const auto b = static_cast<std::size_t>(world_.find("walls")->tag(fields::part)[wall_particle]);
    out += fmt::format(
        "; it lies inside of boundary '{}' ({}): likely it started there, or was "
        "pushed through its surface",
        parameters.boundaries[b].name, parameters.boundaries[b].location);
  } else if (!look_for.empty()) {
    out += "; likely: " + look_for;
  } else if (world_.clock.advection_steps < 3) {
    out +=
        "; likely: a start far from equilibrium, such as bodies that touch or a formula that is no "
        "number";
  } else {
    out +=
        "; likely: pressures that the speed of sound cannot carry, or a formula that is no number "
        "at that time";
  }
  return out;
}

template <int Dim>
void Guard<Dim>::stop(std::string cause, const ParticleSet<Dim>& set, const FieldSpec& field,
                      Index i, const std::string& what, const std::string& look_for) {
  const Vec3 at = to_space<Dim>(set.vector(fields::position)[i]);
  const std::string effect = writer_of(set.name(), field);
  throw UnstableError(
      fmt::format("set '{}' became unstable at t = {:.6g} s (advection step {}): {} particle {} at "
                  "({:.4g}, {:.4g}, {:.4g}) m{}{}",
                  set.name(), world_.clock.time, world_.clock.advection_steps, what, set.ids()[i],
                  at.x(), at.y(), at.z(), effect.empty() ? "" : ", by effect " + effect,
                  suspect(set, i, look_for)),
      {std::move(cause), effect, set.name(), set.ids()[i], at, world_.clock.time});
}

template <int Dim>
std::vector<std::pair<std::string, double>> Guard<Dim>::extremes() const {
  std::vector<std::pair<std::string, double>> out{{"max_mach", largest_mach_}};
  if (world_.find("water")) {
    out.emplace_back("max_mach_water", water_mach_);
    out.emplace_back("max_mach_water_time", water_mach_time_);
  }
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    if (seen_[k].first > seen_[k].second) continue;
    out.emplace_back(fmt::format("min_{}_{}", bounds_[k].field->name, bounds_[k].set),
                     seen_[k].first);
    out.emplace_back(fmt::format("max_{}_{}", bounds_[k].field->name, bounds_[k].set),
                     seen_[k].second);
  }
  for (const auto& [name, n] : world_.lost())
    out.emplace_back("lost_" + name, static_cast<double>(n));
  for (const auto& [name, n] : in_walls_)
    out.emplace_back("in_walls_" + name, static_cast<double>(n));
  return out;
}

template <int Dim>
void Guard<Dim>::save(StateSink& sink) const {
  for (const auto& [name, n] : initial_) sink.put_count("guard/initial/" + name, n);
  for (const auto& [name, n] : in_walls_) sink.put_count("guard/in_walls/" + name, n);
  sink.put_number("guard/largest_dt", largest_dt_);
  sink.put_number("guard/largest_solid", largest_solid_);
  sink.put_number("guard/largest_mach", largest_mach_);
  sink.put_number("guard/water_mach", water_mach_);
  sink.put_number("guard/water_mach_time", water_mach_time_);
  std::vector<double> flat;
  for (const auto& [low, high] : seen_) flat.insert(flat.end(), {low, high});
  sink.put("guard/seen", flat);
  put_spent(sink, "guard/spent", spent_);
  sink.put_count("guard/calls", calls_);
}

template <int Dim>
void Guard<Dim>::load(const StateSource& source) {
  for (auto& [name, n] : initial_) n = source.count("guard/initial/" + name);
  for (const auto& s : world_.sets())
    if (const std::string at = "guard/in_walls/" + s->name(); source.has(at))
      in_walls_[s->name()] = source.count(at);
  largest_dt_ = source.number("guard/largest_dt");
  largest_solid_ = source.has("guard/largest_solid") ? source.number("guard/largest_solid") : 0;
  largest_mach_ = source.number("guard/largest_mach");
  water_mach_ = source.number("guard/water_mach");
  water_mach_time_ = source.number("guard/water_mach_time");
  std::vector<double> flat(2 * seen_.size());
  source.get("guard/seen", std::span<double>(flat));
  for (std::size_t k = 0; k < seen_.size(); ++k) seen_[k] = {flat[2 * k], flat[2 * k + 1]};
  spent_ = spent_of(source, "guard/spent");
  calls_ = source.count("guard/calls");
}

template class Guard<2>;
template class Guard<3>;

}  // namespace sphgeo
