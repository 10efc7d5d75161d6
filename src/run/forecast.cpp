#include "run/forecast.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "run/recorder.h"
#include "run/run_output.h"
#include "run/thread_count.h"
#include "run/wishes.h"
#include "scene/extent.h"

namespace sphgeo {
namespace {

// No set may be larger: offsets of records are 32-bit numbers.
constexpr double largest_set = (1 << 29) - 2;
// Above this many particles a few steps would take longer than a calibration may.
constexpr double calibrated_particles = 400'000;
// Upper bound of the memory of a particle, bytes: what fits with it needs no closer estimate.
constexpr double generous_bytes = 10'000;
// Memory of a particle of water where the scene has none to measure, bytes (measured).
constexpr double entering_bytes_2d = 600, entering_bytes_3d = 1100;
// Files of a run beside frames and rows: the resolved deck, the summary, the heads of the tables.
constexpr double fixed_files = 16'000;
// Memory of HDF5 for building a checkpoint: its code and caches (measured).
constexpr double checkpoint_library = 5.5e6;
// Size of a checkpoint without particles: the deck, counters, and HDF5's own tables.
constexpr double checkpoint_fixed = 265e3;
// An entry of a collection of frames.
constexpr double entry_bytes = 90;

// Spacings of the ladder over that of the deck.
constexpr double ladder[] = {2.0, 1.41, 1 / 1.41, 0.5};

Index whole(double x) { return static_cast<Index>(std::llround(std::clamp(x, 0.0, 9e18))); }

double fluid(const ParticleCounts& counts) { return total_of(counts) - count_of(counts, "walls"); }

double ratio(double a, double b) { return b > 0 ? a / b : 1; }

/// The spacing at which the deck has about `wanted` particles, m.
double spacing_for(const Model& model, double wanted) {
  double spacing = model.resolution;
  for (int k = 0; k < 8; ++k) {
    const double n = total_of(expected_particles(at_resolution(model, spacing)));
    if (!(n > 0) || !std::isfinite(n)) break;
    spacing *= std::pow(n / wanted, 1.0 / model.dimension);
  }
  return spacing;
}

/// A coarse copy of the scene, planned and arranged, from which the memory of a large one is
/// estimated.
template <int Dim>
struct CoarseCopy {
  Model model;
  Diagnostics found;
  Scene<Dim> scene;
  std::unique_ptr<Plan<Dim>> plan;

  CoarseCopy(const Model& original, double wanted)
      : model(coarse(original, wanted)), scene(build_scene<Dim>(model, found, Filling::draft)) {
    plan = std::make_unique<Plan<Dim>>(*scene.world, wishes_of(*scene.model, *scene.world));
    scene.world->rearrange();
  }

  static Model coarse(const Model& original, double wanted) {
    Model m = at_resolution(original, spacing_for(original, wanted));
    for (Body& b : m.bodies) b.filling = "lattice";
    m.relaxation.file.reset();  // made for another spacing
    return m;
  }
};

/// Peak memory of the process in bytes, from two coarse copies. The memory of a particle depends on
/// the spacing to first order, by the fraction of particles near a surface: it is extrapolated
/// linearly from the two.
template <int Dim>
class MemoryRule {
 public:
  explicit MemoryRule(const Model& model) {
    const double finer = Dim == 2 ? 8000 : 40'000;
    const Look fine = look(model, finer), coarse = look(model, finer / (1 << Dim));
    spacing_ = fine.spacing;
    for (const MemoryShare& f : fine.shares)
      for (const MemoryShare& c : coarse.shares) {
        if (c.what != f.what || c.set != f.set) continue;
        const double n = count_of(fine.counts, f.set), m = count_of(coarse.counts, c.set);
        if (!(n > 0 && m > 0) || coarse.spacing <= fine.spacing) continue;
        rules_.push_back(
            {f.set, f.bytes / n, (f.bytes / n - c.bytes / m) / (fine.spacing - coarse.spacing)});
        break;
      }
  }
  double operator()(const Model& model) const {
    const ParticleCounts counts = expected_particles(model);
    const double finer = std::min(0.0, model.resolution - spacing_);
    double sum = static_cast<double>(resident_memory());
    for (const Rule& r : rules_)
      sum += count_of(counts, r.set) * std::max(0.0, r.each + r.slope * finer);
    return sum;
  }

 private:
  struct Look {
    double spacing;
    std::vector<MemoryShare> shares;
    ParticleCounts counts;
  };
  static Look look(const Model& model, double wanted) {
    CoarseCopy<Dim> copy(model, wanted);
    std::vector<MemoryShare> shares = memory_shares(*copy.scene.world, *copy.plan);
    for (const auto& set : copy.scene.world->sets())
      shares.push_back({"checkpoint", set->name(), saved_bytes(*set)});
    return {copy.model.resolution, merged(shares), counts_of(*copy.scene.world)};
  }
  /// Shares of the same name and set as one.
  static std::vector<MemoryShare> merged(const std::vector<MemoryShare>& shares) {
    std::vector<MemoryShare> out;
    for (const MemoryShare& s : shares) {
      const auto same = std::find_if(out.begin(), out.end(), [&](const MemoryShare& o) {
        return o.what == s.what && o.set == s.set;
      });
      if (same == out.end()) out.push_back(s);
      else same->bytes += s.bytes;
    }
    return out;
  }

  struct Rule {
    std::string set;
    double each;   ///< bytes per particle at the finer spacing
    double slope;  ///< over the spacing
  };
  std::vector<Rule> rules_;
  double spacing_ = 0;
};

double largest_of(const ParticleCounts& counts) {
  double most = 0;
  for (const auto& [set, n] : counts) most = std::max(most, n);
  return most;
}

template <int Dim>
void refuse(const Model& model, double available) {
  const MemoryRule<Dim> need(model);
  const auto fits = [&](const Model& m) {
    return need(m) <= available && largest_of(expected_particles(m)) <= largest_set;
  };
  if (fits(model)) return;
  double least = model.resolution, spacing = least;
  while (!fits(at_resolution(model, spacing))) {
    least = spacing;
    spacing *= 2;
  }
  for (int k = 0; k < 8; ++k) {
    const double middle = std::sqrt(least * spacing);
    (fits(at_resolution(model, middle)) ? spacing : least) = middle;
  }
  // Two digits are enough, rounded to the coarser side.
  const double digit = std::pow(10.0, std::floor(std::log10(spacing)) - 1);
  spacing = std::ceil(spacing / digit) * digit;
  const ParticleCounts counts = expected_particles(model);
  Diagnostics found;
  found.error(
      "E145", model.place_of("resolution"), "resolution",
      largest_of(counts) > largest_set && need(model) <= available
          ? fmt::format("the scene takes about {:.3g} particles; a set holds at most {:.3g}",
                        total_of(counts), largest_set)
          : fmt::format("the scene takes about {:.3g} particles and {} of memory; {} are available",
                        total_of(counts), bytes_text(need(model)), bytes_text(available)),
      fmt::format("a resolution of {:.2g} m would fit", spacing));
  throw DeckError(found);
}

}  // namespace

void refuse_too_large(const Model& model) {
  Diagnostics far = {};
  check_extent(model, far);
  if (far.has_errors()) throw DeckError(far);
  const ParticleCounts counts = expected_particles(model);
  const auto available =
      static_cast<double>(available_memory()) + static_cast<double>(resident_memory());
  // An unbounded shape is reported by the filling, which names it.
  if (!std::isfinite(total_of(counts)) &&
      !std::isfinite(total_of(expected_particles(at_resolution(model, 1e3 * model.resolution)))))
    return;
  // A particle takes some 500 bytes at least, whatever else the scene holds.
  if (const double entering = entering_particles(model);
      entering > largest_set || 500 * entering > available) {
    Diagnostics found;
    found.error("E142", model.place_of("boundaries"), "boundaries",
                fmt::format("inlets insert about {:.3g} particles until the end; {:.3g} fit into "
                            "the memory, and a set holds {:.3g}",
                            entering, available / 500, largest_set),
                "a coarser resolution, a smaller inlet, a lower share, or an earlier end");
    throw DeckError(found);
  }
  if (total_of(counts) * generous_bytes <= available && largest_of(counts) <= largest_set) return;
  if (model.dimension == 2) refuse<2>(model, available);
  else refuse<3>(model, available);
}

template <int Dim>
ForecastBasis::ForecastBasis(const Model& model, World<Dim>& world, const Plan<Dim>& plan,
                             const SoundSpeed& sound, const std::vector<Wish>& wishes,
                             const BoundaryMesh& walls, std::uint64_t base, int asked_threads)
    : model_(model),
      asked_threads_(asked_threads),
      counts_(counts_of(world)),
      shares_(memory_shares(world, plan)),
      base_(static_cast<double>(base)),
      steps_(expected_steps(world, plan, typical_speed(world, sound), model_.end_time)),
      output_(run_output(model, world, wishes, walls, steps_.advection)) {}

RunFigures ForecastBasis::figures(double coarser, const ParticleCounts& at, int with_threads,
                                  const std::optional<MeasuredCosts>& costs) const {
  const double larger = ratio(fluid(at), fluid(counts_)),
               walls = ratio(count_of(at, "walls"), count_of(counts_, "walls"));
  RunFigures r;
  for (const auto& [set, n] : at) r.particles.emplace_back(set, whole(n));
  // Inflow counts fully for the memory at the end, and half for the time on average: outflow is not
  // known in advance.
  const double entering = entering_particles(at_resolution(model_, coarser * model_.resolution));
  r.entering = whole(entering);
  const double at_end = 1 + entering / std::max(1.0, fluid(at)), on_average = 0.5 * (1 + at_end);
  ParticleCounts end = at;
  for (auto& [set, n] : end)
    if (set == "water") n += entering;
  const double unseen =
      count_of(counts_, "water") > 0
          ? 0
          : entering * (model_.dimension == 2 ? entering_bytes_2d : entering_bytes_3d);
  r.memory_bytes = static_cast<std::uint64_t>(
      base_ + bytes_at(shares_, counts_, end) + unseen + output_.series_bytes + checkpoint_library +
      std::max(output_.buffer_bytes, output_.checkpoint_bytes) * larger * at_end);
  r.advection_steps = whole(std::ceil(steps_.advection / coarser));
  r.acoustic_steps = whole(std::ceil(steps_.acoustic / coarser));
  if (costs) {
    const double stepping =
        costs->step.of({steps_.advection / coarser, steps_.acoustic / coarser}) * threads() /
        with_threads;
    r.wall_s = (costs->start + (stepping + output_.observations * costs->observation +
                                output_.frames * costs->frame) *
                                   on_average) *
               larger;
  }
  // The last checkpoint and the one before it.
  const double checkpoints = r.wall_s && *r.wall_s > model_.output.checkpoint_every ? 2 : 1;
  r.disk_bytes = static_cast<std::uint64_t>(
      fixed_files + output_.samples_bytes +
      output_.frames *
          (output_.frame_heads + (output_.frame_bytes - output_.frame_heads) * larger * on_average +
           2 * entry_bytes) +
      output_.walls_bytes * walls +
      checkpoints * (checkpoint_fixed + output_.checkpoint_bytes * larger * at_end));
  return r;
}

Forecast ForecastBasis::operator()(const std::optional<MeasuredCosts>& costs) const {
  Forecast forecast;
  static_cast<RunFigures&>(forecast) = figures(1, counts_, threads(), costs);
  forecast.threads = threads();
  if (costs) forecast.slowdown = costs->step.slowdown;
  const auto memory =
      static_cast<double>(available_memory()) + static_cast<double>(resident_memory());
  const ParticleCounts expected = expected_particles(model_);
  for (const double coarser : ladder) {
    ParticleCounts at = expected_particles(at_resolution(model_, coarser * model_.resolution));
    // The error of the estimate at the deck's own spacing is the same at the others.
    for (auto& [set, n] : at) n *= ratio(count_of(counts_, set), count_of(expected, set));
    const int with_threads = sensible_threads(whole(fluid(at)), asked_threads_);
    LadderRung rung{coarser * model_.resolution, figures(coarser, at, with_threads, costs),
                    with_threads, true};
    rung.fits =
        static_cast<double>(rung.figures.memory_bytes) <= memory && largest_of(at) <= largest_set;
    forecast.ladder.push_back(std::move(rung));
  }
  return forecast;
}

template <int Dim>
std::optional<MeasuredCosts> measure_costs(const Model& model, World<Dim>& world, Plan<Dim>& plan,
                                           const std::vector<Wish>& wishes,
                                           const BoundaryMesh& walls, double start, double steps) {
  const double particles = fluid(counts_of(world));
  if (particles > calibrated_particles) {
    CoarseCopy<Dim> copy(model, calibrated_particles / 2);
    std::optional<MeasuredCosts> costs;
    try {
      costs = measure_costs<Dim>(*copy.scene.model, *copy.scene.world, *copy.plan, wishes,
                                 boundary_mesh(*copy.scene.model), 0, steps);
    } catch (const UnstableError&) {  // of the copy, whose walls may be too thin
    }
    if (!costs) return costs;
    const double larger = ratio(particles, fluid(counts_of(*copy.scene.world)));
    return MeasuredCosts{
        start,
        {costs->step.advection * larger, costs->step.acoustic * larger, costs->step.slowdown},
        costs->observation * larger,
        costs->frame * larger};
  }
  MeasuredCosts costs;
  costs.start = start;
  plan.run(Stage::reinitialize);
  const auto step = calibrate<Dim>(world, plan, 1.0, steps);
  if (!step) return std::nullopt;
  costs.step = *step;
  {
    const QuietWatch watch;
    plan.run(Stage::observe);
    sample_probes(model, world);
    costs.observation = watch.seconds();
  }
  const QuietWatch watch;
  run_output(model, world, wishes, walls, 1e9);
  costs.frame = watch.seconds();
  return costs;
}

template <int Dim>
void RunForecast<Dim>::arrive() {
  timer_.end();
  if (basis_) return;
  basis_.emplace(model_, world_, plan_, sound_, wishes_, walls_, base_, asked_threads_);
  costs_.start = starting_->seconds();
  starting_.reset();
}

template <int Dim>
void RunForecast<Dim>::leave(const std::vector<TimeRow>& rows) {
  if (settled_) return;
  if (timer_.steps() == 0) {
    for (const TimeRow& r : rows) {
      const double each = r.calls > 0 ? r.spent.seconds / static_cast<double>(r.calls) : 0;
      if (r.name == "probes") costs_.observation += each;
      if (r.name == "frames") costs_.frame = each;
    }
    for (const auto& e : plan_.effects())
      if (e.info.stage == Stage::observe && e.calls > 0)
        costs_.observation += e.spent.seconds / static_cast<double>(e.calls);
  }
  const auto steps = static_cast<double>(timer_.steps());
  settled_ = steps >= 3 && (timer_.seconds() > 1 || steps > 0.1 * basis_->advection_steps());
  if (!settled_) timer_.begin();
}

template <int Dim>
std::optional<Forecast> RunForecast<Dim>::result() const {
  if (!basis_) return std::nullopt;
  const auto step = timer_.cost();
  if (!step) return (*basis_)(std::nullopt);
  MeasuredCosts costs = costs_;
  costs.step = *step;
  return (*basis_)(costs);
}

template ForecastBasis::ForecastBasis(const Model&, World<2>&, const Plan<2>&, const SoundSpeed&,
                                      const std::vector<Wish>&, const BoundaryMesh&, std::uint64_t,
                                      int);
template ForecastBasis::ForecastBasis(const Model&, World<3>&, const Plan<3>&, const SoundSpeed&,
                                      const std::vector<Wish>&, const BoundaryMesh&, std::uint64_t,
                                      int);
template std::optional<MeasuredCosts> measure_costs<2>(const Model&, World<2>&, Plan<2>&,
                                                       const std::vector<Wish>&,
                                                       const BoundaryMesh&, double, double);
template std::optional<MeasuredCosts> measure_costs<3>(const Model&, World<3>&, Plan<3>&,
                                                       const std::vector<Wish>&,
                                                       const BoundaryMesh&, double, double);
template class RunForecast<2>;
template class RunForecast<3>;

}  // namespace sphgeo
