#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "cli/commands.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "core/version.h"
#include "output/summary.h"
#include "scene/build.h"
#include "solve/stepper.h"
#include "sph/lanes.h"

namespace sphgeo {
namespace {

using clock_type = std::chrono::steady_clock;

/// A fixed scene: its deck for about n particles.
struct BenchScene {
  const char* name;
  std::string (*deck)(long n);
  double h_over_dp;
  std::optional<double> goal_single,
      goal_double;  ///< million updates/s/core at 150 000 particles, from the design
};

std::string water_block(long n, double h_factor) {
  const int cells = std::max(4, static_cast<int>(std::lround(std::cbrt(static_cast<double>(n)))));
  // A free block with a smooth velocity field: all pair terms are active, and nothing else.
  return fmt::format(
      "dimension: 3\nresolution: 1\ngravity: [0, 0, 0]\nend_time: 1e6\n"
      "materials: [{{name: water, type: water, sound_speed: 10, viscosity: 0.1}}]\n"
      "bodies: [{{name: block, material: water, shape: {{type: box, min: [0, 0, 0], max: [{0}, "
      "{0}, {0}]}},\n"
      "          velocity: ['0.1*sin(y)', '0.1*sin(z)', '0.1*sin(x)']}}]\n"
      "numerics: {{h_factor_water: {1}}}\n",
      cells, h_factor);
}

std::string soil_block(long n) {
  const int cells = std::max(4, static_cast<int>(std::lround(std::cbrt(static_cast<double>(n)))));
  // As the block of water; the strength is such that a part is plastic.
  return fmt::format(
      "dimension: 3\nresolution: 1\ngravity: [0, 0, 0]\nend_time: 1e6\n"
      "materials: [{{name: soil, type: soil, density: 1000, volume_fraction: 1, youngs_modulus: "
      "1.2e5, friction_angle: 30 deg, cohesion: 1 kPa}}]\n"
      "bodies: [{{name: block, material: soil, shape: {{type: box, min: [0, 0, 0], max: [{0}, {0}, "
      "{0}]}},\n"
      "          velocity: ['0.1*sin(y)', '0.1*sin(z)', '0.1*sin(x)']}}]\n",
      cells);
}

std::string solid_block(long n) {
  const int cells = std::max(4, static_cast<int>(std::lround(std::cbrt(static_cast<double>(n)))));
  return fmt::format(
      "dimension: 3\nresolution: 1\ngravity: [0, 0, 0]\nend_time: 1e6\n"
      "materials: [{{name: rubber, type: elastic, density: 1000, youngs_modulus: 1e5}}]\n"
      "bodies: [{{name: block, material: rubber, shape: {{type: box, min: [0, 0, 0], max: [{0}, "
      "{0}, {0}]}},\n"
      "          velocity: ['0.1*sin(y)', '0.1*sin(z)', '0.1*sin(x)']}}]\n",
      cells);
}

std::string dam_break(long n) {
  // A column of 2:1:1 in a tank four times as long, with walls: the share of wall pairs is that of
  // a real run.
  const double cells = std::cbrt(static_cast<double>(n) / 2);
  const int height = std::max(4, static_cast<int>(std::lround(cells)));
  return fmt::format(
      "dimension: 3\nresolution: 1\ngravity: 9.81\nend_time: 1e6\n"
      "materials: [{{name: water, type: water}}]\n"
      "bodies: [{{name: column, material: water, shape: {{type: box, min: [0, 0, 0], max: [{1}, "
      "{0}, {0}]}}, pressure: hydrostatic}}]\n"
      "boundaries: [{{name: tank, type: tank, min: [0, 0, 0], max: [{2}, {0}, {1}], open: "
      "[top]}}]\n",
      height, 2 * height, 4 * height);
}

std::string saturated_block(long n) {
  // Soil and its pore water in one block, n particles in all: 1 of soil and 0.4 of water to a cell.
  const int cells =
      std::max(4, static_cast<int>(std::lround(std::cbrt(static_cast<double>(n) / 1.4))));
  return fmt::format(
      "dimension: 3\nresolution: 1\ngravity: [0, 0, 0]\nend_time: 1e6\n"
      "materials:\n  - {{name: water, type: water, sound_speed: 10, viscosity: 0.1}}\n"
      "  - {{name: soil, type: soil, density: 2000, volume_fraction: 0.6, youngs_modulus: 1.2e5, "
      "friction_angle: 30 deg, cohesion: 1 kPa, grain_size: 1e-3}}\n"
      "bodies:\n  - {{name: water, material: water, shape: {{type: box, min: [0, 0, 0], max: [{0}, "
      "{0}, {0}]}}}}\n"
      "  - {{name: soil, material: soil, shape: {{type: box, min: [0, 0, 0], max: [{0}, {0}, "
      "{0}]}},\n"
      "     velocity: ['0.1*sin(y)', '0.1*sin(z)', '0.1*sin(x)']}}\nrelaxation: {{steps: 20}}\n",
      cells);
}

const BenchScene scenes[] = {
    {"water_block_h1.3", [](long n) { return water_block(n, 1.3); }, 1.3, 5.0, 2.8},
    {"water_block_h1.8", [](long n) { return water_block(n, 1.8); }, 1.8, 2.8, 1.4},
    {"soil_block_h1.3", soil_block, 1.3, 3.7, 1.9},
    {"solid_block_h1.15", solid_block, 1.15, 4.5, 2.8},
    {"saturated_block", saturated_block, 1.8, 1.8, 1.0},
    {"dam_break", dam_break, 1.8, std::nullopt, std::nullopt},
};

/// A fixed loop of multiply-adds in registers, one thread: measures the present speed of the
/// machine, GFlop/s.
double calibrate() {
  using L = Lanes<float>;
  L a[8];
  for (int k = 0; k < 8; ++k) a[k] = L(1.0f + 0.1f * static_cast<float>(k));
  const L factor(0.999f), term(0.001f);
  const double start = processor_seconds();
  constexpr long rounds = 4'000'000;
  for (long r = 0; r < rounds; ++r)
    for (int k = 0; k < 8; ++k) a[k] = a[k] * factor + term;
  const double seconds = processor_seconds() - start;
  volatile float keep = 0;
  for (int k = 0; k < 8; ++k) keep = keep + sum(a[k]);
  return 2.0 * 8 * L::width * rounds / seconds / 1e9;
}

struct Measured {
  double updates = 0;      ///< acoustic stages only, per s and core
  double updates_all = 0;  ///< with rearrangements and reinitialization
  double pairs = 0;        ///< pair interactions per s and core
  double search_ns = 0;    ///< sort, grid and lists, per particle
  double bytes = 0;        ///< per particle, without those of walls
  double calibration = 0;
  long particles = 0;
};

/// Best of several repeats of the same scene.
Measured measure(const std::string& deck, int thread_count, const BenchOptions& options) {
  set_threads(thread_count);
  const Model model = read_deck_text(deck);
  Diagnostics found;
  Scene<3> scene = build_scene<3>(model, found);
  if (found.has_errors()) throw DeckError(found);
  World<3>& world = *scene.world;
  Plan<3> plan(world, {});
  Stepper<3> stepper(world, plan);
  Measured best;
  for (const auto& set : world.sets())
    if (set->phase() != "wall") best.particles += static_cast<long>(set->size());
  const auto acoustic_seconds = [&] {
    double s = 0;
    for (const auto& e : plan.effects())
      if (e.info.stage != Stage::reinitialize && e.info.stage != Stage::observe)
        s += e.spent.seconds;
    return s;
  };
  stepper.run(0.0, {[] { return false; }});  // first lists, outside of the measurement
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    const double calibration = calibrate();
    const auto start = clock_type::now();
    const double processor0 = processor_seconds();
    const double acoustic0 = acoustic_seconds(), search0 = stepper.rearranging().seconds;
    const double updates0 = stepper.particle_updates();
    const long searches0 = stepper.rearrangements();
    stepper.run(model.end_time, {[&] {
                  return seconds_since(start) < options.seconds ||
                         stepper.particle_updates() == updates0;
                }});
    const double updates = stepper.particle_updates() - updates0;
    // For one thread only its processor time is counted, so that other programs disturb less.
    const double wall = seconds_since(start);
    const double had =
        thread_count == 1 ? std::min(1.0, (processor_seconds() - processor0) / wall) : 1.0;
    const double acoustic = had * (acoustic_seconds() - acoustic0), all = had * wall;
    const double per_core = 1.0 / thread_count;
    Index walked = 0;
    for (const auto& [key, list] : world.lists()) walked += list.pairs();
    best.updates = std::max(best.updates, updates / acoustic * per_core);
    best.updates_all = std::max(best.updates_all, updates / all * per_core);
    // Each list is walked twice in an acoustic step.
    const double pairs = 2.0 * static_cast<double>(walked) / static_cast<double>(best.particles) *
                         updates / acoustic * per_core;
    best.pairs = std::max(best.pairs, pairs);
    const double search = had * (stepper.rearranging().seconds - search0) /
                          static_cast<double>(stepper.rearrangements() - searches0) /
                          static_cast<double>(best.particles) * 1e9 * thread_count;
    best.search_ns = best.search_ns == 0 ? search : std::min(best.search_ns, search);
    best.calibration = std::max(best.calibration, calibration);
  }
  best.bytes =
      static_cast<double>(world.bytes() + plan.bytes()) / static_cast<double>(best.particles);
  return best;
}

}  // namespace

int bench_command(const BenchOptions& options) {
  if (options.effects) return bench_effects_command(options);
  std::vector<std::string> names;
  for (const BenchScene& s : scenes) names.push_back(s.name);
  for (const std::string& wanted : options.scenes)
    if (std::find(names.begin(), names.end(), wanted) == names.end())
      throw Error(ExitCode::usage, fmt::format("there is no bench scene '{}'; {}", wanted,
                                               suggestion(wanted, names)));
  const std::vector<long> sizes =
      options.sizes.empty() ? std::vector<long>{20'000, 150'000, 1'000'000} : options.sizes;
  const int all = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<int> thread_counts{1};
  if (all > 1) thread_counts.push_back(all);

  nlohmann::ordered_json j;
  j["version"] = version();
  j["lanes_single"] = native_width<float>;
  j["scenes"] = nlohmann::ordered_json::array();
  if (!options.json)
    fmt::print(
        "best of {} repeats of {} s; one update = one particle through one acoustic step;\n"
        "processor time for one thread, wall time for more\n"
        "{:<18} {:>9} {:>7} {:>8} {:>9} {:>9} {:>10} {:>7} {:>9} {:>12}  {}\n",
        options.repeats, options.seconds, "scene", "particles", "pairs", "threads", "Mupd/s",
        "all-in", "Gpairs/s", "B/part", "search ns", "calibration",
        "goal (Mupd/s/core at 150 000, one thread)");
  for (const BenchScene& scene : scenes) {
    if (!options.scenes.empty() &&
        std::find(options.scenes.begin(), options.scenes.end(), scene.name) == options.scenes.end())
      continue;
    for (const char* precision : {"single", "double"}) {
      if (options.precision != "both" && options.precision != precision) continue;
      for (const long size : sizes)
        for (const int t : thread_counts) {
          std::string deck = scene.deck(size);
          deck += deck.find("numerics:") == std::string::npos
                      ? fmt::format("numerics: {{pair_precision: {}}}\n", precision)
                      : "";
          const auto at = deck.find("{h_factor_water");
          if (at != std::string::npos)
            deck.insert(at + 1, fmt::format("pair_precision: {}, ", precision));
          const Measured m = measure(deck, t, options);
          const auto goal =
              std::string(precision) == "single" ? scene.goal_single : scene.goal_double;
          j["scenes"].push_back(
              {{"name", scene.name},
               {"particles", m.particles},
               {"threads", t},
               {"pair_precision", precision},
               {"h_over_dp", scene.h_over_dp},
               {"particle_updates_per_s_per_core", m.updates},
               {"particle_updates_per_s_per_core_all_in", m.updates_all},
               {"pair_interactions_per_s_per_core", m.pairs},
               {"bytes_per_particle", m.bytes},
               {"search_ns_per_particle", m.search_ns},
               {"calibration", m.calibration},
               {"updates_per_calibration_gflop", m.updates / m.calibration},
               {"goal_updates_per_s_per_core",
                goal ? nlohmann::ordered_json(*goal * 1e6) : nlohmann::ordered_json()}});
          if (options.json) continue;
          const std::string target =
              goal && size == 150'000 && t == 1
                  ? fmt::format("{:.1f}: {:.0f} %", *goal, m.updates / *goal / 1e4)
                  : "";
          fmt::print(
              "{:<18} {:>9} {:>7} {:>8} {:>9.2f} {:>9.2f} {:>10.2f} {:>7.0f} {:>9.0f} {:>12.0f}  "
              "{}\n",
              scene.name, m.particles, precision, t, m.updates / 1e6, m.updates_all / 1e6,
              m.pairs / 1e9, m.bytes, m.search_ns, m.calibration, target);
          std::cout.flush();
        }
    }
  }
  if (options.json) std::cout << j.dump(2) << "\n";
  return 0;
}

}  // namespace sphgeo
