#include "relax/relax_deck.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/version.h"
#include "geometry/mesh.h"
#include "output/pvd.h"
#include "output/vtu.h"
#include "run/forecast.h"
#include "run/relaxation_report.h"

namespace sphgeo {
namespace {

std::span<const double> whole(const std::vector<double>& v) { return v; }

/// The frames before the first step and after the last, at the "times" 0 and the number of steps.
void write_frames(const Model& model, const PoreWater& water, const RunFolder& folder) {
  std::vector<Vec3> after;
  std::vector<std::int32_t> part;
  for (std::size_t b = 0; b < water.bodies.size(); ++b) {
    after.insert(after.end(), water.particles[b].begin(), water.particles[b].end());
    part.resize(after.size(), static_cast<std::int32_t>(water.bodies[b]));
  }
  const double dp_volume = std::pow(model.resolution, model.dimension);
  const char* unit = model.dimension == 2 ? "m2" : "m3";
  const WaterTarget target(model);
  PvdFile collection(folder.pvd("water"));
  const auto write = [&](Index number, double step, const std::vector<Vec3>& at,
                         const std::vector<double>* density) {
    std::vector<double> fraction(at.size()), volume(at.size());
    parallel_for(static_cast<Index>(at.size()), [&](Index i) {
      const auto k = static_cast<std::size_t>(i);
      fraction[k] = density ? water.water_fraction[k] : target.fraction(at[k]);
      volume[k] = dp_volume / std::max(fraction[k], WaterTarget::smallest);
    });
    std::vector<VtuField> columns{{"part", "", 1, std::span<const std::int32_t>(part)},
                                  {"water_fraction", "", 1, whole(fraction)},
                                  {"target_volume", unit, 1, whole(volume)}};
    columns.push_back({"number_density", "", 1, whole(density ? *density : water.start_density)});
    VtuOptions options;
    options.time = step;
    write_vtu(folder.frame("water", number), at, columns, options);
    collection.add(step, RunFolder::frame_name("water", number));
  };
  write(0, 0, water.start, nullptr);
  write(1, static_cast<double>(std::max<std::size_t>(water.history.size(), 2) - 1), after,
        &water.number_density);
}

/// The surfaces of the soils, as lines or triangles.
void write_outlines(const Model& model, const RunFolder& folder) {
  std::vector<Vec3> points;
  std::vector<Index> corners;
  const WaterTarget target(model);
  for (const WaterTarget::Skeleton& s : target.soils()) {
    const SurfaceMesh mesh = surface_mesh(*s.shape, 2 * model.resolution, model.dimension);
    const auto first = static_cast<Index>(points.size());
    points.insert(points.end(), mesh.points.begin(), mesh.points.end());
    const auto add = [&](const auto& cells) {
      for (const auto& cell : cells)
        for (const std::int32_t c : cell) corners.push_back(first + c);
    };
    if (model.dimension == 2) add(mesh.segments);
    else add(mesh.triangles);
  }
  const std::vector<std::int32_t> part(corners.size() / static_cast<std::size_t>(model.dimension));
  write_vtu_mesh(folder.frame("soil_surface", 0), points, model.dimension, corners, {},
                 {{"part", "", 1, std::span<const std::int32_t>(part)}});
  PvdFile(folder.pvd("soil_surface")).add(0, RunFolder::frame_name("soil_surface", 0));
}

nlohmann::ordered_json report_of(const Model& model, const PoreWater& water) {
  const double dp_volume = std::pow(model.resolution, model.dimension);
  nlohmann::ordered_json j;
  j["steps"] = water.history.empty() ? 0 : water.history.size() - 1;
  j["particles"] = water.accepted;
  j["moved"] = water.moved;
  j["interior"] = water.interior;
  j["water_volume"] = water.volume;
  j["mass_error"] = water.mass_error(dp_volume);
  if (!water.history.empty()) {
    j["density_spread"] = water.history.back().density_spread;
    j["density_mean"] = water.history.back().density_mean;
    j["density_spread_at_start"] = water.history.front().density_spread;
    j["water_density_spread"] = water.water_density_spread;
  }
  j["seconds"] = water.seconds;
  return j;
}

}  // namespace

RelaxResult relax_deck(const Model& model, const RunSettings& settings, RunObserver& observer) {
  refuse_too_large(model);
  Diagnostics found = model.warnings;
  const std::optional<PoreBodies> pores = pore_bodies(model);
  if (!pores)
    throw Error(ExitCode::usage,
                settings.deck + ": the deck has no pore water at t = 0: there is nothing to relax");
  const FolderLock lock(settings.folder);
  const RunFolder folder(settings.folder, settings.existing);
  if (settings.threads > 0) set_threads(settings.threads);
  std::optional<PoreWater> water = pore_water(model, found, Relaxing::anew);
  if (found.has_errors() || !water) throw DeckError(found);
  if (!found.items().empty()) observer.findings(found);

  write_file_atomically(folder.resolved_deck(), resolved_yaml(model));
  StateFileWriter out(relaxed_kind(),
                      static_cast<std::size_t>(water->accepted) * 5 * sizeof(double));
  put(*water, depends_on(model, *pores), out);
  out.write(folder.relaxed(), "");
  const Series history = relaxation_series(model, *water);
  write_relaxation(folder.probe_csv(relaxation_probe), history);
  write_frames(model, *water, folder);
  write_outlines(model, folder);

  Summary summary;
  summary.status = "done";
  summary.expect = evaluate(relaxation_expects(model, true), [&](const std::string& name) {
    return name == relaxation_probe ? &history : nullptr;
  });
  const bool met = std::all_of(summary.expect.begin(), summary.expect.end(),
                               [](const ExpectResult& r) { return r.pass; });
  summary.exit_code =
      static_cast<int>(settings.verify && !met ? ExitCode::mismatch : ExitCode::done);
  summary.version = version();
  summary.title = model.title;
  summary.deck = settings.deck;
  summary.deck_hash = deck_hash(model);
  summary.dimension = model.dimension;
  summary.threads = threads();
  summary.particles = {{"water", water->accepted}};
  summary.memory_peak_bytes = peak_memory_bytes();
  summary.disk_bytes = folder_bytes(settings.folder);
  summary.wall_s = seconds_since(settings.start);
  nlohmann::ordered_json j = to_json(summary);
  j["relaxation"] = report_of(model, *water);
  write_file_atomically(
      folder.summary(),
      j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
  return {std::move(*water), std::move(summary)};
}

}  // namespace sphgeo
