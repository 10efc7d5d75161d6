#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/preview.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "run/forecast.h"
#include "run/relaxation_report.h"
#include "run/thread_count.h"
#include "run/wishes.h"
#include "scene/build.h"
#include "scene/cross_check.h"
#include "scene/particle_count.h"

namespace sphgeo {
namespace {

nlohmann::ordered_json plan_json(const auto& world, const auto& plan) {
  nlohmann::ordered_json j;
  j["plan"] = nlohmann::ordered_json::array();
  for (const auto& e : plan.effects())
    j["plan"].push_back({{"stage", stage_name(e.info.stage)},
                         {"name", e.info.name},
                         {"equations", e.info.equations},
                         {"acts_on", e.effect->acts_on()},
                         {"because", e.because}});
  j["unused"] = nlohmann::ordered_json::array();
  for (const auto& u : plan.unused())
    j["unused"].push_back({{"name", u.name}, {"because", u.because}});
  j["lists"] = nlohmann::ordered_json::array();
  for (const auto& [key, list] : world.lists())
    j["lists"].push_back({{"target", key.first},
                          {"source", key.second},
                          {"pairs", list.pairs()},
                          {"bytes", list.bytes()}});
  j["fields"] = nlohmann::ordered_json::array();
  constexpr const char* lifetimes[] = {"state", "reference", "derived"};
  for (const auto& set : world.sets())
    for (const auto& [name, field] : set->fields())
      j["fields"].push_back({{"set", set->name()},
                             {"name", name},
                             {"unit", field->spec().unit.symbol},
                             {"lifetime", lifetimes[static_cast<int>(field->spec().lifetime)]}});
  j["records"] = nlohmann::ordered_json::array();
  for (const RecordRow& r : record_rows(plan.records())) {
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const RecordFieldSpec& f : r.record->fields)
      if (f.name) names.push_back(f.name);
    j["records"].push_back({{"set", r.set},
                            {"name", r.record->name},
                            {"what", r.record->sentence},
                            {"fields", names},
                            {"array", r.record->array},
                            {"array_bytes", world.records().bytes(r.set, r.record->array)},
                            {"written_by", r.written_by},
                            {"read_by", r.read_by},
                            {"used_up_by", r.used_up_by},
                            {"shares_with", r.shares_with}});
  }
  j["memory_bytes"] = world.bytes() + plan.bytes();
  return j;
}

std::string joined(const nlohmann::ordered_json& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name.get<std::string>();
  return text;
}

void print_plan(const nlohmann::ordered_json& j) {
  std::cout << fmt::format("\nplan: effects, and why they run\n");
  for (const auto& e : j["plan"])
    std::cout << fmt::format("  {:<13} {:<24} {:<22} {:<18} {}\n", e["stage"].get<std::string>(),
                             e["name"].get<std::string>(), e["equations"].get<std::string>(),
                             e["acts_on"].get<std::string>(), e["because"].get<std::string>());
  std::cout << fmt::format("not used\n");
  for (const auto& u : j["unused"])
    std::cout << fmt::format("  {:<38} {}\n", u["name"].get<std::string>(),
                             u["because"].get<std::string>());
  std::cout << fmt::format("neighbor lists\n");
  for (const auto& l : j["lists"])
    std::cout << fmt::format("  {} -> {}: {} pairs, {}\n", l["target"].get<std::string>(),
                             l["source"].get<std::string>(), l["pairs"].get<long>(),
                             bytes_text(l["bytes"].get<double>()));
  std::cout << fmt::format("fields\n");
  std::string set;
  for (const auto& f : j["fields"]) {
    if (f["set"] != set)
      std::cout << fmt::format("{}  {}:", set.empty() ? "" : "\n", f["set"].get<std::string>());
    set = f["set"];
    std::cout << fmt::format(" {}({})", f["name"].get<std::string>(),
                             f["lifetime"].get<std::string>());
  }
  std::cout << fmt::format("\npacked records\n");
  for (const auto& r : j["records"]) {
    std::cout << fmt::format("  {}: {} ({}), array {} of {}\n", r["set"].get<std::string>(),
                             r["name"].get<std::string>(), joined(r["fields"]),
                             r["array"].get<int>(), bytes_text(r["array_bytes"].get<double>()));
    for (const auto& [key, says] :
         {std::pair("written_by", "written by"), std::pair("read_by", "read by"),
          std::pair("used_up_by", "packed and used up by"),
          std::pair("shares_with", "shares numbers with")})
      if (!r[key].empty()) std::cout << fmt::format("    {} {}\n", says, joined(r[key]));
  }
  std::cout << fmt::format("memory {}\n", bytes_text(j["memory_bytes"].get<double>()));
}

/// The cost of a run; with the time unless `--no-calibrate`. Advances the world.
template <int Dim>
std::optional<Forecast> forecast_of(const Model& model, World<Dim>& world, Plan<Dim>& plan,
                                    const SoundSpeed& sound, const std::vector<Wish>& wishes,
                                    std::uint64_t base, const CheckOptions& options,
                                    const QuietWatch& start) {
  if (world.sets().empty()) return std::nullopt;
  const double started = start.seconds();
  const BoundaryMesh walls = boundary_mesh(model);
  const ForecastBasis basis(model, world, plan, sound, wishes, walls, base, options.threads);
  std::optional<MeasuredCosts> costs;
  if (options.calibrate && basis.advection_steps() > 0) {
    try {
      costs =
          measure_costs<Dim>(model, world, plan, wishes, walls, started, basis.advection_steps());
    } catch (const UnstableError& e) {
      throw Error(ExitCode::usage, fmt::format("the scene fails in its first steps: {}", e.what()));
    }
    if (!costs)
      std::cerr << "warning: a coarse copy of the scene becomes unstable in its first steps; the "
                   "time is not forecast\n";
  }
  return basis(costs);
}

template <int Dim>
int check(const Model& model, const CheckOptions& options, const QuietWatch& start) {
  const std::uint64_t base = resident_memory();
  Diagnostics found = model.warnings;
  Scene<Dim> scene = build_scene<Dim>(model, found, Filling::draft);
  check_scene(scene, found);
  // Also for a scene with mistakes, where a picture is most useful.
  const std::string preview =
      options.preview.empty() ? "" : write_preview<Dim>(model, *scene.world, options.preview);
  if (found.has_errors()) throw DeckError(found);
  if (!found.items().empty()) std::cerr << found.render();
  if (!preview.empty()) std::cerr << fmt::format("{}: {}\n", printable(options.preview), preview);
  World<Dim>& world = *scene.world;
  set_threads(sensible_threads(moving_particles(world), options.threads));
  const std::vector<Wish> wishes = wishes_of(model, world);
  Plan<Dim> plan(world, wishes);
  world.rearrange();

  nlohmann::ordered_json j = plan_json(world, plan);
  nlohmann::ordered_json particles;
  Index total = 0;
  for (const auto& set : world.sets()) {
    particles[set->name()] = set->size();
    total += set->size();
  }
  j["particles"] = particles;
  for (const BodyCount& b : scene.body_particles)
    j["bodies"].push_back({{"name", b.name},
                           {"particles", b.particles},
                           {"filling", b.filling.relaxed ? "relaxed" : "lattice"},
                           {"because", b.filling.because}});
  j["sound_speed"] = {{"value", scene.sound.value},
                      {"max_speed", scene.sound.max_speed},
                      {"because", scene.sound.because}};
  const StepLimits steps = world.sets().empty() ? StepLimits{} : plan.limits();
  const bool stepping = std::isfinite(steps.advection) && std::isfinite(steps.acoustic);
  if (stepping) {
    j["time_steps"] = {{"advection", steps.advection},
                       {"acoustic", steps.acoustic},
                       {"acoustic_by", steps.acoustic_by}};
    if (std::isfinite(steps.solid)) j["time_steps"]["solid"] = steps.solid;
  }
  const std::optional<Forecast> forecast =
      forecast_of<Dim>(model, world, plan, scene.sound, wishes, base, options, start);
  if (forecast) j["forecast"] = to_json(*forecast);
  if (options.json) {
    std::cout << j.dump(2) << "\n";
    return 0;
  }
  std::cout << fmt::format("{}: {} dimensions, spacing {} m, {} s\n",
                           printable(model.title.empty() ? options.deck : model.title), Dim,
                           model.resolution, model.end_time);
  // As they were before the calibration, in which inlets work.
  for (const auto& [set, n] : particles.items())
    std::cout << fmt::format("  {:<10} {:>10} particles\n", set, n.dump());
  for (const BodyCount& b : scene.body_particles)
    std::cout << fmt::format("    body '{}': {}, {} ({})\n", b.name, b.particles,
                             b.filling.relaxed ? "relaxed" : "on a lattice", b.filling.because);
  for (const auto& [name, n] : scene.boundary_particles)
    std::cout << fmt::format("    boundary '{}': {}\n", name, n);
  if (scene.pore_water)
    std::cout << fmt::format("  {}\n", printable(relaxation_line(model, *scene.pore_water)));
  if (world.find("water"))
    std::cout << fmt::format("  speed of sound {:.4g} m/s: {}\n", scene.sound.value,
                             scene.sound.because);
  if (stepping)
    std::cout << fmt::format(
        "  time steps at the start: advection {:.3g} s, acoustic {:.3g} s, bounded by {}{}\n",
        steps.advection, steps.acoustic, steps.acoustic_by,
        std::isfinite(steps.solid) ? fmt::format(", solids {:.3g} s", steps.solid) : "");
  if (options.explain) print_plan(j);
  if (forecast) std::cout << fmt::format("{}", render_forecast(*forecast, model.resolution));
  if (const double entering = entering_particles(model); entering > 0)
    std::cout << fmt::format(
        "inlets insert about {:.3g} particles of water until the end: the forecast counts all of "
        "them for the memory, half of them for the time\n",
        entering);
  std::cout << fmt::format("the deck is correct\n");
  return 0;
}

}  // namespace

int check_command(const CheckOptions& options) {
  const QuietWatch start;
  const Model model = read_deck(options.deck, options.set);
  refuse_too_large(model);
  if (options.threads > 0) set_threads(options.threads);  // also while the scene is built
  return model.dimension == 2 ? check<2>(model, options, start) : check<3>(model, options, start);
}

}  // namespace sphgeo
