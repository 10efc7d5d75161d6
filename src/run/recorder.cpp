#include "run/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "probes/set_sums.h"
#include "probes/solid_scene.h"
#include "run/thread_count.h"
#include "scene/build.h"
#include "scene/world_view.h"

namespace sphgeo {
namespace {

// Length of a CSV file at a checkpoint.
std::uint64_t bytes_at(const StateSource& source, const std::string& series) {
  return static_cast<std::uint64_t>(source.count(series + "/bytes"));
}

std::vector<Column> run_columns(bool soil) {
  std::vector<Column> columns{
      {"advection_steps", "1", "advection steps so far"},
      {"acoustic_steps", "1", "acoustic steps so far"},
      {"dt_advection", "s", "last advection step"},
      {"dt_acoustic", "s", "last acoustic step"},
      {"particles", "1", "particles without those of walls"},
      {"lost", "1", "particles that have left the domain since t = 0"},
      {"max_speed", "m/s", "largest speed"},
      {"min_density", "kg/m3", "smallest density of the water"},
      {"max_density", "kg/m3", "largest density of the water"},
      {"mass", "kg", "mass of all moving sets (per metre of depth in 2D)"},
      {"momentum_x", "kg m/s", "momentum of all moving sets"},
      {"momentum_y", "kg m/s", "momentum of all moving sets"},
      {"momentum_z", "kg m/s", "momentum of all moving sets"},
      {"kinetic", "J", "kinetic energy"},
      {"potential", "J", "potential energy"},
      {"internal", "J", "energy of compression of water, elastic energy of soil and solids"},
      {"wall_seconds", "s", "wall time since the start"}};
  if (soil) {
    columns.push_back({"dissipated", "J", "energy dissipated by plastic flow of the soil"});
    columns.push_back({"min_volume_fraction", "1", "smallest volume fraction of the soil"});
    columns.push_back({"max_volume_fraction", "1", "largest volume fraction of the soil"});
  }
  return columns;
}

}  // namespace

void Schedule::done(double time) { next_ = (std::floor(time / interval_ + 1e-9) + 1) * interval_; }

template <int Dim>
Recorder<Dim>::Recorder(const Model& model, World<Dim>& world, Plan<Dim>& plan,
                        const BoundaryMesh& walls, const RunFolder& folder,
                        const StateSource* resume)
    : model_(model),
      world_(world),
      plan_(plan),
      frame_times_(model.frame_interval()),
      rows_(model.run_interval()),
      run_("run", run_columns(world.find("soil") != nullptr)),
      frames_(model, world, walls, folder, files_) {
  if (resume) run_.resume(folder.run_csv(), bytes_at(*resume, "output/run"));
  else run_.write_to(folder.run_csv());
  for (const auto& spec : model.probes) {
    auto probe = std::dynamic_pointer_cast<const Probe>(spec);
    auto series = std::make_unique<Series>(spec->name, probe->columns(model));
    if (resume)
      series->resume(folder.probe_csv(spec->name),
                     bytes_at(*resume, "output/probes/" + spec->name));
    else series->write_to(folder.probe_csv(spec->name));
    probes_.push_back({std::move(probe), Schedule(model.probe_interval(*spec)), std::move(series)});
  }
  if (resume) load(*resume);
  frames_.open();
}

template <int Dim>
void Recorder<Dim>::flush() {
  files_.wait();
  run_.flush(true);
  for (ProbeRun& p : probes_) p.series->flush(true);
}

template <int Dim>
void Recorder<Dim>::wait_for_disk() const {
  run_.wait_for_disk();
  for (const ProbeRun& p : probes_) p.series->wait_for_disk();
}

template <int Dim>
void Recorder<Dim>::save(StateSink& sink) {
  const auto put_bytes = [&](const std::string& at, Series& series) {
    sink.put_count(at + "/bytes", static_cast<std::int64_t>(series.flush()));
  };
  put_bytes("output/run", run_);
  sink.put_number("output/run/next", rows_.next());
  for (ProbeRun& p : probes_) {
    put_bytes("output/probes/" + p.series->name(), *p.series);
    sink.put_number("output/probes/" + p.series->name() + "/next", p.schedule.next());
  }
  frames_.save(sink);
  sink.put_number("output/frames/next", frame_times_.next());
  put_spent(sink, "output/probes_spent", spent_probes_);
  sink.put_count("output/probes_calls", calls_probes_);
  // The ledger compares with the first row, which may be from an earlier process.
  for (const auto& [name, totals] : {std::pair{"first", &first_}, std::pair{"latest", &latest_}})
    if (*totals)
      sink.put(std::string("output/ledger/") + name, std::bit_cast<TotalsArray>(**totals));
}

template <int Dim>
void Recorder<Dim>::load(const StateSource& source) {
  rows_.set_next(source.number("output/run/next"));
  for (ProbeRun& p : probes_)
    p.schedule.set_next(source.number("output/probes/" + p.series->name() + "/next"));
  frames_.load(source);
  frame_times_.set_next(source.number("output/frames/next"));
  spent_probes_ = spent_of(source, "output/probes_spent");
  calls_probes_ = source.count("output/probes_calls");
  for (const auto& [name, totals] : {std::pair{"first", &first_}, std::pair{"latest", &latest_}})
    if (const std::string at = std::string("output/ledger/") + name; source.has(at)) {
      TotalsArray numbers;
      source.get(at, std::span<double>(numbers));
      *totals = std::bit_cast<Totals>(numbers);
    }
}

template <int Dim>
void Recorder<Dim>::observe(double wall_seconds, bool last) {
  files_.check();
  const double t = world_.clock.time;
  const bool frame = last || frame_times_.due(t), row = last || rows_.due(t);
  const auto due = [&](const ProbeRun& p) { return last || p.schedule.due(t); };
  if (!frame && !row && std::none_of(probes_.begin(), probes_.end(), due)) return;
  plan_.run(Stage::observe);

  {
    const Stopwatch watch(spent_probes_);
    for (ProbeRun& p : probes_)
      if (due(p)) sample_probe(p);
    if (row) {
      sample_run(wall_seconds);
      rows_.done(t);
    }
  }
  ++calls_probes_;
  if (!frame) return;
  write_frame();
  frame_times_.done(t);
}

template <int Dim>
void Recorder<Dim>::sample_probe(ProbeRun& p) {
  std::vector<std::optional<double>> values(p.series->columns().size());
  const WorldView<Dim> view(model_, world_);
  p.probe->sample(view, values);
  p.series->add(world_.clock.time, std::span<const std::optional<double>>(values));
  p.schedule.done(world_.clock.time);
}

// Contributions that all moving sets have in common.
template <int Dim>
void Recorder<Dim>::add_set_totals(const ParticleSet<Dim>& set, const Energies& e, Totals& sum) {
  const auto& m = set.scalar(fields::mass);
  const auto& v = set.vector(fields::velocity);
  const Index n = set.size();
  sum.kinetic += e.kinetic;
  sum.potential += e.potential;
  sum.internal += e.internal;
  sum.mass += ordered_sum(n, [&](Index i) { return m[i]; });
  const Vec3 momentum =
      to_space<Dim>(ordered_sum(n, [&](Index i) -> Vec<Dim> { return m[i] * v[i]; }));
  for (std::size_t k = 0; k < 3; ++k) sum.momentum[k] += momentum[static_cast<Index>(k)];
  sum.max_speed =
      std::max(sum.max_speed, std::sqrt(block_max(
                                  n, [&](Index i) { return v[i].squaredNorm(); }, 0.0)));
}

template <int Dim>
void Recorder<Dim>::add_soil_totals(const ParticleSet<Dim>& soil, Totals& sum) const {
  const WorldView<Dim> view(model_, world_);
  const auto& fraction = soil.scalar(fields::volume_fraction);
  const Index n = soil.size();
  add_set_totals(soil, soil_energies(view), sum);
  sum.dissipated = dissipated_energy(view);
  sum.min_fraction = block_min(n, [&](Index i) { return fraction[i]; });
  sum.max_fraction = block_max(n, [&](Index i) { return fraction[i]; });
}

template <int Dim>
typename Recorder<Dim>::Totals Recorder<Dim>::totals() const {
  Totals sum;
  sum.time = world_.clock.time;
  for (const auto& [name, account] : world_.exchanged()) {
    sum.mass_in += account.mass;
    sum.energy_in += account.energy;
    const Vec3 p = to_space<Dim>(account.momentum);
    for (std::size_t k = 0; k < 3; ++k) sum.momentum_in[k] += p[static_cast<Index>(k)];
  }
  const ParticleSet<Dim>* water = world_.find("water");
  if (const ParticleSet<Dim>* soil = world_.find("soil")) add_soil_totals(*soil, sum);
  for (const auto& set : world_.sets())
    if (set->phase() == "solid")
      add_set_totals(*set, solid_energies(WorldView<Dim>(model_, world_), set->name()), sum);
  sum.internal += contact_energy(WorldView<Dim>(model_, world_));
  if (!water) return sum;
  const auto& m = water->scalar(fields::mass);
  const auto& rho = water->scalar(fields::density);
  const Index n = water->size();
  add_set_totals(*water, water_energies(WorldView<Dim>(model_, world_)), sum);
  sum.min_density = block_min(n, [&](Index i) { return rho[i]; });
  sum.max_density = block_max(n, [&](Index i) { return rho[i]; });
  if (!water->has(fields::water_fraction)) return sum;
  const auto& fraction = water->scalar(fields::water_fraction);
  const bool follows = world_.parameters().water.follows_porosity;
  sum.water_volume = ordered_sum(n, [&](Index i) { return m[i] / rho[i]; });
  sum.mixture_volume =
      ordered_sum(n, [&](Index i) { return m[i] / (rho[i] * (follows ? fraction[i] : 1.0)); });
  return sum;
}

template <int Dim>
void Recorder<Dim>::sample_run(double wall_seconds) {
  const Totals t = totals();
  if (!first_) first_ = t;
  latest_ = t;
  Index lost = 0;
  for (const auto& [name, count] : world_.lost()) lost += count;
  const Clock& c = world_.clock;
  const double row[] = {static_cast<double>(c.advection_steps),
                        static_cast<double>(c.acoustic_steps),
                        c.dt_advection,
                        c.dt_acoustic,
                        static_cast<double>(moving_particles(world_)),
                        static_cast<double>(lost),
                        t.max_speed,
                        t.min_density,
                        t.max_density,
                        t.mass,
                        t.momentum[0],
                        t.momentum[1],
                        t.momentum[2],
                        t.kinetic,
                        t.potential,
                        t.internal,
                        wall_seconds,
                        t.dissipated,
                        t.min_fraction,
                        t.max_fraction};
  run_.add(c.time, std::span<const double>(row).first(run_.columns().size()));
}

template <int Dim>
const Series* Recorder<Dim>::series(const std::string& probe) const {
  if (probe == "run") return &run_;
  for (const ProbeRun& p : probes_)
    if (p.series->name() == probe) return p.series.get();
  return nullptr;
}

template <int Dim>
std::vector<TimeRow> Recorder<Dim>::time_rows() const {
  return {{"probes", calls_probes_, spent_probes_}, frames_.time_row()};
}

template <int Dim>
std::vector<LedgerRow> Recorder<Dim>::ledger() const {
  if (!first_ || !latest_) return {};
  const Totals &a = *first_, &b = *latest_;
  const double speed = std::max({a.max_speed, b.max_speed, 1e-300});
  const auto relative = [](double difference, double scale) {
    return scale > 0 ? std::abs(difference) / scale : 0.0;
  };
  const double energy_a = a.kinetic + a.potential + a.internal,
               energy_b = b.kinetic + b.potential + b.internal;
  const double energy_scale = std::max({std::abs(energy_a), a.kinetic, b.kinetic});
  const auto vec = [](const std::array<double, 3>& v) { return Vec3(v[0], v[1], v[2]); };
  const auto list = [](const std::array<double, 3>& v) {
    return std::vector<double>(v.begin(), v.end());
  };
  const double mass_in = b.mass_in - a.mass_in, energy_in = b.energy_in - a.energy_in;
  const Vec3 momentum_in = vec(b.momentum_in) - vec(a.momentum_in);
  std::vector<LedgerRow> rows{
      {"mass",
       "kg",
       {a.mass},
       {b.mass},
       {},
       relative(b.mass - a.mass - mass_in, std::max(a.mass, b.mass))},
      {"momentum",
       "kg m/s",
       list(a.momentum),
       list(b.momentum),
       {},
       relative((vec(b.momentum) - vec(a.momentum) - momentum_in).norm(),
                std::max(a.mass, b.mass) * speed)},
      {"energy",
       "J",
       {energy_a},
       {energy_b},
       {},
       relative(energy_b - energy_a - energy_in, std::max(energy_scale, std::abs(energy_in)))}};
  if (!world_.exchanged().empty()) {
    rows[0].exchanged = {mass_in};
    rows[1].exchanged = {momentum_in.x(), momentum_in.y(), momentum_in.z()};
    rows[2].exchanged = {energy_in};
  }
  if (a.water_volume > 0) {
    const std::string cubic = Dim == 2 ? "m2" : "m3";
    rows.push_back({"water_volume",
                    cubic,
                    {a.water_volume},
                    {b.water_volume},
                    {},
                    relative(b.water_volume - a.water_volume, a.water_volume)});
    rows.push_back({"mixture_volume",
                    cubic,
                    {a.mixture_volume},
                    {b.mixture_volume},
                    {},
                    relative(b.mixture_volume - a.mixture_volume, a.mixture_volume)});
  }
  std::vector<Tally> tallies;
  for (const auto& e : plan_.effects()) e.effect->tally(tallies);
  for (const Tally& t : tallies) rows.push_back({t.name, t.unit, {}, {t.value}, {}, 0.0});
  if (world_.find("soil"))
    rows.push_back({"dissipated",
                    "J",
                    {a.dissipated},
                    {b.dissipated},
                    {},
                    relative(b.dissipated - a.dissipated, energy_scale)});
  return rows;
}

template class Recorder<2>;
template class Recorder<3>;

}  // namespace sphgeo
