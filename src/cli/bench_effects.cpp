// `sphgeo bench --effects`: a scene as planned, and the same with effects added that it does not
// need.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/commands.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/text.h"
#include "core/version.h"
#include "scene/build.h"
#include "solve/stepper.h"

namespace sphgeo {
namespace {

/// A change of a scene that needs more effects.
struct Forcing {
  const char* what;
  std::string materials, bodies, numerics;  ///< added to the deck's lists
  bool all_fields =
      false;  ///< every field that an effect can compute is requested in each advection step
  const char* at_body = "";  ///< keys added to the scene's own body
};

/// A scene, and the additions to it.
struct EffectScene {
  const char* name;
  std::string materials, body, boundaries;
  double end;  ///< of the scene along x, m: distant bodies lie beyond
  std::vector<Forcing> forcings;
};

std::string box(double x0, double x1, double y1, double z1) {
  return fmt::format("shape: {{type: box, min: [{}, 0, 0], max: [{}, {}, {}]}}", x0, x1, y1, z1);
}

std::string deck(const EffectScene& scene, const Forcing* forced) {
  std::string text =
      "dimension: 3\nresolution: 1\ngravity: [0, 0, 0]\nend_time: 1e9\nmaterials:\n" +
      scene.materials;
  if (forced) text += forced->materials;
  text += "bodies:\n  - {" + scene.body + (forced ? forced->at_body : "") + "}\n";
  if (forced) text += forced->bodies;
  if (!scene.boundaries.empty()) text += "boundaries:\n" + scene.boundaries;
  text += "relaxation: {steps: 20}\n";
  if (forced && !forced->numerics.empty()) text += "numerics: {" + forced->numerics + "}\n";
  return text;
}

/// About n particles each. Without gravity, so that distant bodies stay there.
std::vector<EffectScene> effect_scenes(long n) {
  const int c = std::max(6, static_cast<int>(std::lround(std::cbrt(static_cast<double>(n)))));
  const std::string water = "  - {name: water, type: water, sound_speed: 10, viscosity: 0.1}\n";
  const std::string soil =
      "  - {name: soil, type: soil, density: 2000, volume_fraction: 0.6, youngs_modulus: 1.2e5, "
      "friction_angle: 30 deg, cohesion: 1 kPa, grain_size: 1e-3}\n";
  const std::string rubber =
      "  - {name: rubber, type: elastic, density: 1000, youngs_modulus: 1e5}\n";
  const std::string rock = "  - {name: rock, type: rigid, density: 2600, stiffness: 1e5}\n";
  const std::string moving = "velocity: ['0.1*sin(y)', '0.1*sin(z)', '0.1*sin(x)']";
  const std::string whole = box(0, c, c, c);
  const double far = 3.0 * c + 20;
  const auto away = [&](const std::string& name) {
    return fmt::format("  - {{name: away, material: {}, {}}}\n", name, box(far, far + 4, 4, 4));
  };
  const auto within = [&](const std::string& name) {
    return fmt::format("  - {{name: within, material: {}, {}}}\n", name, whole);
  };
  const Forcing fields{"every field, in every advection step", "", "", "", true};
  return {
      {"water",
       water,
       "name: block, material: water, " + moving + ", " + whole,
       "",
       far,
       {{"soil far away", soil, away("soil"), ""},
        {"soil in all of it", soil, within("soil"), ""},
        {"a rigid body far away", rock, away("rock"), ""},
        {"an elastic body far away", rubber, away("rubber"), ""},
        {"double precision", "", "", "pair_precision: double"},
        fields}},
      {"soil",
       soil,
       "name: block, material: soil, " + moving + ", " + whole,
       "",
       far,
       {{"water far away", water, away("water"), ""},
        {"water in all of it", water, within("water"), ""},
        {"a rigid body far away", rock, away("rock"), ""},
        {"transport velocity of soil", "", "", "transport_velocity_soil: true"},
        fields}},
      {"solid",
       rubber,
       "name: block, material: rubber, " + moving + ", " + whole,
       "",
       far,
       {{"contact: another body far away", "", away("rubber"), ""},
        {"contact with itself", "", "", "", false, ", self_contact: true"},
        {"water far away", water, away("water"), ""},
        {"the quadratic gradient", "", "", "solid_gradient: quadratic"},
        fields}},
  };
}

/// Requests for all fields that supporting effects can compute in this world.
std::vector<Wish> all_wishes(const World<3>& world) {
  std::vector<Wish> wishes;
  for (const auto& entry : EffectRegistry::all()) {
    if (!entry.info.supporting) continue;
    for (const auto& effect : entry.bind<3>(world).effects)
      for (const FieldUse& use : effect->needs().fields)
        if (use.access != Access::read) wishes.push_back({use.set, use.field->name, "bench", true});
  }
  return wishes;
}

/// A built scene that can be stepped for a while.
class Stand {
 public:
  Stand(const std::string& text, bool all_fields)
      : model_(read_deck_text(text)), all_fields_(all_fields), scene_(build()) {
    plan_ = std::make_unique<Plan<3>>(*scene_.world,
                                      all_fields ? all_wishes(*scene_.world) : std::vector<Wish>{});
    stepper_ = std::make_unique<Stepper<3>>(*scene_.world, *plan_);
    stepper_->run(0.0, {[] { return false; }});  // the first lists
  }

  /// Steps for about so many seconds; keeps the smallest processor time for a second of the scene:
  /// steps differ in length.
  void run(double seconds) {
    const auto start = std::chrono::steady_clock::now();
    const double before = processor_seconds();
    const Index steps = scene_.world->clock.acoustic_steps;
    const double begun = scene_.world->clock.time;
    stepper_->run(
        model_.end_time, {[&] {
          if (all_fields_) plan_->run(Stage::observe);
          return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() <
                     seconds ||
                 scene_.world->clock.acoustic_steps == steps;
        }});
    const double spent = processor_seconds() - before;
    const double each = spent / (scene_.world->clock.time - begun);
    second_s_ = second_s_ == 0 ? each : std::min(second_s_, each);
    const double step = spent / static_cast<double>(scene_.world->clock.acoustic_steps - steps);
    step_s_ = step_s_ == 0 ? step : std::min(step_s_, step);
  }

  double seconds_per_second() const { return second_s_; }
  double step_seconds() const { return step_s_; }
  double bytes() const { return static_cast<double>(scene_.world->bytes() + plan_->bytes()); }
  std::size_t fields() const {
    std::size_t sum = 0;
    for (const auto& set : scene_.world->sets()) sum += set->fields().size();
    return sum;
  }
  std::set<std::string> effects() const {
    std::set<std::string> names;
    for (const auto& e : plan_->effects()) names.insert(e.label);
    return names;
  }
  Index particles() const {
    Index sum = 0;
    for (const auto& set : scene_.world->sets()) sum += set->size();
    return sum;
  }

 private:
  Scene<3> build() {
    Diagnostics found;
    Scene<3> scene = build_scene<3>(model_, found);
    if (found.has_errors()) throw DeckError(found);
    return scene;
  }

  Model model_;
  bool all_fields_;
  Scene<3> scene_;
  std::unique_ptr<Plan<3>> plan_;
  std::unique_ptr<Stepper<3>> stepper_;
  double second_s_ = 0, step_s_ = 0;
};

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& n : names) text += (text.empty() ? "" : " ") + n;
  return text;
}

}  // namespace

int bench_effects_command(const BenchOptions& options) {
  const std::vector<EffectScene> scenes =
      effect_scenes(options.sizes.empty() ? 30'000 : options.sizes.front());
  std::vector<std::string> names;
  for (const EffectScene& s : scenes) names.push_back(s.name);
  for (const std::string& wanted : options.scenes)
    if (std::find(names.begin(), names.end(), wanted) == names.end())
      throw Error(ExitCode::usage, fmt::format("there is no scene '{}' for --effects; {}", wanted,
                                               suggestion(wanted, names)));
  set_threads(1);
  nlohmann::ordered_json j = {{"version", version()}, {"scenes", nlohmann::ordered_json::array()}};
  if (!options.json)
    fmt::print(
        "one thread; processor time for the same simulated time, smallest of {} repeats of {} s;\n"
        "each line relative to the scene as planned, measured alternately\n",
        options.repeats, options.seconds);
  for (const EffectScene& scene : scenes) {
    if (!options.scenes.empty() &&
        std::find(options.scenes.begin(), options.scenes.end(), scene.name) == options.scenes.end())
      continue;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    std::size_t width = 0;
    for (const Forcing& f : scene.forcings) width = std::max(width, std::string(f.what).size());
    bool first = true;
    for (const Forcing& f : scene.forcings) {
      Stand planned(deck(scene, nullptr), false), forced(deck(scene, &f), f.all_fields);
      for (int repeat = 0; repeat < options.repeats; ++repeat) {
        planned.run(options.seconds);
        forced.run(options.seconds);
      }
      std::vector<std::string> added;
      const std::set<std::string> before = planned.effects();
      for (const std::string& e : forced.effects())
        if (!before.contains(e)) added.push_back(e);
      const double time = forced.seconds_per_second() / planned.seconds_per_second(),
                   memory = forced.bytes() / planned.bytes();
      rows.push_back({{"forced", f.what},
                      {"step_s", forced.step_seconds()},
                      {"planned_step_s", planned.step_seconds()},
                      {"time_ratio", time},
                      {"memory_ratio", memory},
                      {"fields", forced.fields()},
                      {"planned_fields", planned.fields()},
                      {"particles", forced.particles()},
                      {"planned_particles", planned.particles()},
                      {"effects_added", added}});
      if (options.json) continue;
      if (std::exchange(first, false))
        fmt::print(
            "\n{}: {} particles, {} effects, {} fields, {:.1f} MB, {:.2f} ms a step\n  {:<{}}  "
            "{:>6}  {:>6}  {:>6}  effects added\n",
            scene.name, planned.particles(), before.size(), planned.fields(), planned.bytes() / 1e6,
            1e3 * planned.step_seconds(), "forced", width, "time", "memory", "fields");
      fmt::print("  {:<{}}  {:>5.2f}x  {:>5.2f}x  {:>6}  {}: {}\n", f.what, width, time, memory,
                 fmt::format("{:+}", static_cast<long>(forced.fields()) -
                                         static_cast<long>(planned.fields())),
                 added.size(), list_of(added));
      std::cout.flush();
    }
    j["scenes"].push_back({{"name", scene.name}, {"rows", std::move(rows)}});
  }
  if (options.json) std::cout << j.dump(2) << "\n";
  return 0;
}

}  // namespace sphgeo
