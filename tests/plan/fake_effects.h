#pragma once
// Small effects for tests of the planner. Each scenario is a particle set of its own name: only a
// world that has this set sees the effects of the scenario.

#include <string>
#include <vector>

#include "effects/effect.h"

namespace sphgeo::test {

struct FakeSpec {
  std::string scenario;  ///< name of the set
  std::string name;
  Stage stage;
  std::vector<std::pair<const FieldSpec*, Access>> fields;
  bool supporting = false;
  bool with_list = false;
};

/// All names of fakes begin with this.
inline const std::string fake_prefix = "fake_";

inline const FakeSpec& fake(int k) {
  using enum Access;
  static const std::vector<FakeSpec> all{
      // Named so that the alphabet is the wrong order.
      {"order", "fake_a_read", Stage::force, {{&fields::pressure, read}}, false, true},
      {"order", "fake_b_update", Stage::force, {{&fields::pressure, update}}},
      {"order", "fake_c_add", Stage::force, {{&fields::pressure, add}}},
      {"order", "fake_d_write", Stage::force, {{&fields::pressure, write}}},
      {"order", "fake_e_early", Stage::predict, {{&fields::density, update}}},
      {"missing", "fake_missing", Stage::force, {{&fields::volume, read}}},
      {"twins", "fake_twin_1", Stage::force, {{&fields::volume, write}}},
      {"twins", "fake_twin_2", Stage::force, {{&fields::volume, write}}},
      {"two_stages", "fake_stage_1", Stage::predict, {{&fields::volume, write}}},
      {"two_stages", "fake_stage_2", Stage::observe, {{&fields::volume, write}}},
      {"cycle",
       "fake_cycle_1",
       Stage::force,
       {{&fields::volume, write}, {&fields::pressure, read}}},
      {"cycle",
       "fake_cycle_2",
       Stage::force,
       {{&fields::pressure, write}, {&fields::volume, read}}},
      {"lonely_add", "fake_lonely_add", Stage::force, {{&fields::pressure, add}}},
      {"lonely_add", "fake_early_write", Stage::predict, {{&fields::pressure, write}}},
      // A chain: y is made from x.
      {"chain", "fake_makes_x", Stage::observe, {{&fields::volume, write}}, true},
      {"chain",
       "fake_makes_y",
       Stage::observe,
       {{&fields::wall_force, write}, {&fields::volume, read}},
       true},
      {"chain", "fake_always", Stage::force, {{&fields::density, update}}},
      // The same field in a stage before: what observers need does not serve the step.
      {"late", "fake_late_support", Stage::observe, {{&fields::volume, write}}, true},
      {"late", "fake_early_reader", Stage::force, {{&fields::volume, read}}},
  };
  return all.at(static_cast<std::size_t>(k));
}
inline constexpr int fakes = 19;

template <int K>
struct FakeCase {
  template <int Dim>
  struct Run final : Effect<Dim> {
    static EffectInfo info() {
      const FakeSpec& f = fake(K);
      return {f.name, f.stage, "", "for tests of the planner", f.supporting};
    }
    static Binding<Dim> bind(const World<Dim>& world) {
      if (!world.find(fake(K).scenario)) return {"there is no set '" + fake(K).scenario + "'"};
      return {std::make_unique<Run>(), "there is the set '" + fake(K).scenario + "'"};
    }
    std::string acts_on() const override { return fake(K).scenario; }
    Needs needs() const override {
      Needs n;
      for (const auto& [field, access] : fake(K).fields)
        n.fields.push_back({fake(K).scenario, field, access});
      if (fake(K).with_list) n.lists.push_back({fake(K).scenario, fake(K).scenario});
      return n;
    }
    void apply(World<Dim>& world) override { ++world.clock.advection_steps; }  // seen by the tests
    void limit(const World<Dim>&, StepLimits& limits) const override {
      limits.acoustic = std::min(limits.acoustic, 1.0 + K);
      limits.advection = std::min(limits.advection, 100.0 - K);
    }
  };
};

}  // namespace sphgeo::test
