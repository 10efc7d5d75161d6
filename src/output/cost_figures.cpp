#include "output/cost_figures.h"

#include <fmt/format.h>

#include <filesystem>

#include "output/progress.h"

namespace sphgeo {

using Json = nlohmann::ordered_json;

Index RunFigures::total_particles() const {
  Index sum = 0;
  for (const auto& [set, n] : particles) sum += n;
  return sum;
}

Json to_json(const RunFigures& f) {
  Json out;
  out["particles"] = Json::object();
  for (const auto& [set, n] : f.particles) out["particles"][set] = n;
  if (f.entering > 0) out["entering"] = f.entering;
  out["memory_bytes"] = f.memory_bytes;
  out["disk_bytes"] = f.disk_bytes;
  out["advection_steps"] = f.advection_steps;
  out["acoustic_steps"] = f.acoustic_steps;
  out["wall_s"] = f.wall_s ? Json(*f.wall_s) : Json(nullptr);
  return out;
}

Json to_json(const Forecast& f) {
  Json out = to_json(static_cast<const RunFigures&>(f));
  out["threads"] = f.threads;
  out["slowdown"] = f.slowdown;
  out["ladder"] = Json::array();
  for (const LadderRung& r : f.ladder) {
    Json row = {{"resolution", r.resolution}};
    row.update(to_json(r.figures));
    row["threads"] = r.threads;
    row["fits"] = r.fits;
    out["ladder"].push_back(std::move(row));
  }
  return out;
}

namespace {

std::string time_text(const RunFigures& f) {
  if (!f.wall_s) return "-";
  return *f.wall_s < 10 ? fmt::format("{:.1f} s", *f.wall_s) : duration_text(*f.wall_s);
}

std::string row(double resolution, const RunFigures& f, int threads, const char* remark) {
  return fmt::format("  {:>12.4g} {:>12} {:>10} {:>10} {:>12} {:>14} {:>8}{}\n", resolution,
                     f.total_particles(), bytes_text(static_cast<double>(f.memory_bytes)),
                     bytes_text(static_cast<double>(f.disk_bytes)), f.acoustic_steps, time_text(f),
                     threads, remark);
}

}  // namespace

std::string render_forecast(const Forecast& f, double resolution) {
  std::string out = fmt::format(
      "forecast: {} advection and {} acoustic steps, {} on {} thread{}, {} of memory, {} on disk\n",
      f.advection_steps, f.acoustic_steps, f.wall_s ? "about " + time_text(f) : "time unknown",
      f.threads, f.threads == 1 ? "" : "s", bytes_text(static_cast<double>(f.memory_bytes)),
      bytes_text(static_cast<double>(f.disk_bytes)));
  if (f.wall_s && f.slowdown > 1.2)
    out +=
        fmt::format("  by processor time; the machine is busy: now it takes {:.1f} times as long\n",
                    f.slowdown);
  out += fmt::format("  {:>12} {:>12} {:>10} {:>10} {:>12} {:>14} {:>8}\n", "spacing [m]",
                     "particles", "memory", "disk", "acoustic", "wall time", "threads");
  bool own = false;
  const auto own_row = [&] {
    out += row(resolution, f, f.threads, "  <- this deck");
    own = true;
  };
  for (const LadderRung& r : f.ladder) {
    if (!own && r.resolution < resolution) own_row();
    out +=
        row(r.resolution, r.figures, r.threads, r.fits ? "" : "  more than the available memory");
  }
  if (!own) own_row();
  return out;
}

std::uint64_t folder_bytes(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code problem;
  std::uint64_t sum = 0;
  for (fs::recursive_directory_iterator it(folder, problem), end; !problem && it != end;
       it.increment(problem)) {
    std::error_code ignored;
    if (!it->is_regular_file(ignored)) continue;
    const auto size = it->file_size(ignored);
    if (!ignored) sum += size;
  }
  return sum;
}

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.1f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.1f} MB", bytes / 1e6);
  if (bytes < 1e12) return fmt::format("{:.2f} GB", bytes / 1e9);
  return fmt::format("{:.3g} TB", bytes / 1e12);
}

}  // namespace sphgeo
