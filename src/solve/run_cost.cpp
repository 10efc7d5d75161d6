#include "solve/run_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace sphgeo {
namespace {

/// The largest set other than walls, with which scratch memory grows.
template <int Dim>
std::string main_set(const World<Dim>& world) {
  std::string name;
  Index most = -1;
  for (const auto& s : world.sets())
    if (s->phase() != "wall" && s->size() > most) {
      name = s->name();
      most = s->size();
    }
  return name;
}

}  // namespace

template <int Dim>
std::vector<MemoryShare> memory_shares(const World<Dim>& world, const Plan<Dim>& plan) {
  std::vector<MemoryShare> shares;
  const auto total = static_cast<double>(world.bytes());
  double accounted = 0, particles = 0;
  for (const auto& s : world.sets()) {
    shares.push_back({"fields", s->name(), static_cast<double>(s->bytes())});
    shares.push_back({"grid", s->name(), static_cast<double>(world.grid(s->name()).bytes())});
    particles += static_cast<double>(s->size());
  }
  for (const auto& [key, list] : world.lists()) {
    // Between two sets pairs grow with their interface, as does the thinner set: walls are a few
    // spacings thick.
    const bool across = key.first != key.second && world.set(key.second).phase() == "wall";
    shares.push_back({"list", across ? key.second : key.first, static_cast<double>(list.bytes())});
  }
  for (const MemoryShare& s : shares) accounted += s.bytes;
  // The rest are the records, equal for all particles.
  for (const auto& s : world.sets())
    if (particles > 0)
      shares.push_back(
          {"records", s->name(),
           std::max(0.0, total - accounted) * static_cast<double>(s->size()) / particles});
  double scratch = 0;
  for (const auto& e : plan.effects()) scratch += static_cast<double>(e.effect->bytes());
  shares.push_back({"scratch", main_set(world), scratch});
  return shares;
}

double bytes_at(const std::vector<MemoryShare>& shares, const ParticleCounts& from,
                const ParticleCounts& to) {
  double sum = 0;
  for (const MemoryShare& s : shares) {
    const double before = count_of(from, s.set);
    sum += before > 0 ? s.bytes * count_of(to, s.set) / before : s.bytes;
  }
  return sum;
}

template <int Dim>
ParticleCounts counts_of(const World<Dim>& world) {
  ParticleCounts counts;
  for (const auto& s : world.sets()) counts.emplace_back(s->name(), static_cast<double>(s->size()));
  return counts;
}

template <int Dim>
double typical_speed(const World<Dim>& world, const SoundSpeed& sound) {
  double initial = 0;
  for (const auto& s : world.sets())
    if (s->phase() != "wall") {
      const auto& v = s->vector(fields::velocity);
      initial =
          std::max(initial, std::sqrt(block_max(
                                s->size(), [&](Index i) { return v[i].squaredNorm(); }, 0.0)));
    }
  return std::max(initial, 0.5 * sound.max_speed);
}

template <int Dim>
StepCounts expected_steps(World<Dim>& world, const Plan<Dim>& plan, double speed, double duration) {
  // All particles but one of each set are at rest while the plan is evaluated.
  std::vector<std::vector<Vec<Dim>>> kept;
  for (const auto& s : world.sets()) {
    auto& v = s->vector(fields::velocity);
    kept.emplace_back(v.data(), v.data() + v.size());
    if (s->phase() == "wall" || s->size() == 0) continue;
    std::fill(v.data(), v.data() + v.size(), Vec<Dim>(Vec<Dim>::Zero()));
    v[0][0] = speed;
  }
  const StepLimits limits = plan.limits();
  for (std::size_t k = 0; k < kept.size(); ++k)
    std::copy(kept[k].begin(), kept[k].end(), world.sets()[k]->vector(fields::velocity).data());

  if (!std::isfinite(limits.advection) || !(limits.advection > 0)) return {};
  const double advection = std::ceil(duration / limits.advection - 1e-9);
  // As the stepper divides an advection step.
  return {advection,
          advection * std::max(1.0, std::ceil(limits.advection / limits.acoustic - 1e-9))};
}

template <int Dim>
double StepTimer<Dim>::between() const {
  double s = stepper_.rearranging().seconds;
  for (const auto& e : plan_.effects())
    if (e.info.stage == Stage::reinitialize) s += e.spent.seconds;
  return s;
}

template <int Dim>
void StepTimer<Dim>::begin() {
  between_ = between();
  acoustic_ = world_.clock.acoustic_steps;
  begun_ = clock::now();
  watch_.emplace();
}

template <int Dim>
void StepTimer<Dim>::end() {
  if (!begun_) return;
  const double all = std::chrono::duration<double>(clock::now() - *begun_).count();
  samples_.push_back(
      {all, between() - between_, watch_->seconds(), world_.clock.acoustic_steps - acoustic_});
  begun_.reset();
  watch_.reset();
  seconds_ += all;
}

template <int Dim>
std::optional<StepCost> StepTimer<Dim>::cost() const {
  double all = 0, between = 0, quiet = 0;
  long acoustic = 0;
  for (std::size_t k = 1; k < samples_.size(); ++k) {
    all += samples_[k].all;
    between += samples_[k].between;
    quiet += samples_[k].quiet;
    acoustic += samples_[k].acoustic_steps;
  }
  if (acoustic == 0 || !(quiet > 0)) return std::nullopt;
  const double slowdown = all / quiet;
  return StepCost{between / static_cast<double>(samples_.size() - 1) / slowdown,
                  (all - between) / static_cast<double>(acoustic) / slowdown, slowdown};
}

template <int Dim>
std::optional<StepCost> calibrate(World<Dim>& world, Plan<Dim>& plan, double seconds,
                                  double most_steps) {
  Stepper<Dim> stepper(world, plan);
  StepTimer<Dim> timer(world, plan, stepper);
  RunHooks hooks;
  hooks.at_safe_point = [&] {
    timer.end();
    if (timer.steps() >= 3 &&
        (static_cast<double>(timer.steps()) >= most_steps || timer.seconds() >= seconds))
      return false;
    timer.begin();
    return true;
  };
  stepper.run(std::numeric_limits<double>::infinity(), hooks);
  return timer.cost();
}

template std::vector<MemoryShare> memory_shares<2>(const World<2>&, const Plan<2>&);
template std::vector<MemoryShare> memory_shares<3>(const World<3>&, const Plan<3>&);
template ParticleCounts counts_of<2>(const World<2>&);
template ParticleCounts counts_of<3>(const World<3>&);
template double typical_speed<2>(const World<2>&, const SoundSpeed&);
template double typical_speed<3>(const World<3>&, const SoundSpeed&);
template StepCounts expected_steps<2>(World<2>&, const Plan<2>&, double, double);
template StepCounts expected_steps<3>(World<3>&, const Plan<3>&, double, double);
template class StepTimer<2>;
template class StepTimer<3>;
template std::optional<StepCost> calibrate<2>(World<2>&, Plan<2>&, double, double);
template std::optional<StepCost> calibrate<3>(World<3>&, Plan<3>&, double, double);

}  // namespace sphgeo
