#pragma once
// Small effects for tests of the planner. Each scenario is a particle set of its own name: only a
// world that has this set sees the effects of the scenario.

#include <string>
#include <vector>

#include "effects/effect.h"
#include "sph/parameters.h"

namespace sphgeo::test {

/// A world with one set of two particles, named after the scenario.
struct FakeWorld {
  World<2> world{std::make_shared<Parameters>()};
  explicit FakeWorld(const std::string& scenario) {
    world.add_set(scenario, "water", 0.1, 0.13, true).resize(2);
    world.set_domain(Vec<2>::Constant(-1), Vec<2>::Constant(1));
  }
};

/// Records for tests: Second voids the pressure of First, but not its density.
template <int Dim>
struct First : RecordType<Dim> {
  static constexpr RecordField<First, 3> density{};
  static constexpr RecordField<First, 7> pressure{};
  static constexpr RecordSpec spec{
      "first", 0, "for tests", {{{"density", density}, {"pressure", pressure}}}};
};
template <int Dim>
struct Second : RecordType<Dim> {
  static constexpr RecordField<Second, 7> mean{};
  static constexpr RecordSpec spec{"second", 0, "for tests", {{{"mean", mean}}}};
};

/// Names records of a fake; by dimension, as record types are.
enum class FakeRecord { first, density, pressure, second };

struct FakeSpec {
  std::string scenario;  ///< name of the set
  std::string name;
  Stage stage;
  std::vector<std::pair<const FieldSpec*, Access>> fields;
  bool supporting = false;
  bool with_list = false;
  std::vector<std::pair<FakeRecord, Access>> records = {};
  bool reads_first = false, packs_second = false;  ///< whether apply() asks for these records
};

/// All names of fakes begin with this.
inline const std::string fake_prefix = "fake_";

inline const FakeSpec& fake(int k) {
  using enum Access;
  constexpr Stage predict = Stage::predict, force = Stage::force, kick = Stage::kick;
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
       {{&fields::fluid_force, write}, {&fields::volume, read}},
       true},
      {"chain", "fake_always", Stage::force, {{&fields::density, update}}},
      // The same field in a stage before: what observers need does not serve the step.
      {"late", "fake_late_support", Stage::observe, {{&fields::volume, write}}, true},
      {"late", "fake_early_reader", Stage::force, {{&fields::volume, read}}},
      // Values of the last step, and of a field that may not exist.
      {"previous", "fake_previous_w", Stage::force, {{&fields::acceleration, write}}},
      {"previous", "fake_previous_x", Stage::force, {{&fields::acceleration, previous}}},
      {"previous_derived", "fake_derived_w", Stage::force, {{&fields::volume, write}}},
      {"previous_derived", "fake_derived_x", Stage::force, {{&fields::volume, previous}}},
      // Records.
      {"records", "fake_r_1", force, {}, false, false, {{FakeRecord::first, read}}, true},
      {"records", "fake_r_2", force, {}, false, false, {{FakeRecord::pressure, update}}},
      {"records", "fake_r_3", force, {}, false, false, {{FakeRecord::first, write}}},
      {"records", "fake_r_4", kick, {}, false, false, {{FakeRecord::second, write}}, false, true},
      {"records", "fake_r_5", kick, {}, false, false, {{FakeRecord::density, read}}},
      {"records", "fake_r_6", kick, {}, false, false, {{FakeRecord::pressure, previous}}},
      {"no_record", "fake_no_record", force, {}, false, false, {{FakeRecord::first, read}}},
      {"record_twins", "fake_r_twin_1", force, {}, false, false, {{FakeRecord::density, write}}},
      {"record_twins", "fake_r_twin_2", force, {}, false, false, {{FakeRecord::first, write}}},
      {"record_cycle",
       "fake_r_cycle_1",
       force,
       {{&fields::volume, write}},
       false,
       false,
       {{FakeRecord::first, read}}},
      {"record_cycle",
       "fake_r_cycle_2",
       force,
       {{&fields::volume, read}},
       false,
       false,
       {{FakeRecord::first, write}}},
      {"used_up", "fake_used_1", predict, {}, false, false, {{FakeRecord::first, write}}},
      {"used_up", "fake_used_2", force, {}, false, false, {{FakeRecord::second, scratch}}},
      {"used_up", "fake_used_3", kick, {}, false, false, {{FakeRecord::pressure, read}}},
      {"covered", "fake_covered_1", predict, {}, false, false, {{FakeRecord::first, write}}},
      {"covered", "fake_covered_2", force, {}, false, false, {{FakeRecord::second, write}}},
      {"covered", "fake_covered_3", kick, {}, false, false, {{FakeRecord::pressure, read}}},
      // A supporting effect for a record.
      {"record_chain", "fake_r_support", force, {}, true, false, {{FakeRecord::first, write}}},
      {"record_chain", "fake_r_user", force, {}, false, false, {{FakeRecord::first, read}}, true},
      // apply() asks for records that the needs do not name.
      {"undeclared_read",
       "fake_undeclared_read",
       force,
       {},
       false,
       false,
       {{FakeRecord::second, write}},
       true,
       true},
      {"undeclared_write",
       "fake_reads_only",
       force,
       {},
       false,
       false,
       {{FakeRecord::second, read}},
       false,
       true},
      {"undeclared_write", "fake_writes", predict, {}, false, false, {{FakeRecord::second, write}}},
  };
  return all.at(static_cast<std::size_t>(k));
}
inline constexpr int fakes = 45;

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
      for (const auto& [record, access] : fake(K).records) name_record(n, record, access);
      if (fake(K).with_list) n.lists.push_back({fake(K).scenario, fake(K).scenario});
      return n;
    }
    void apply(World<Dim>& world) override {
      ++world.clock.advection_steps;  // seen by the tests
      if (fake(K).reads_first) read_records<First<Dim>, double>(world, fake(K).scenario);
      if (fake(K).packs_second) write_records<Second<Dim>, double>(world, fake(K).scenario);
    }
    void limit(const World<Dim>&, StepLimits& limits) const override {
      limits.acoustic = std::min(limits.acoustic, 1.0 + K);
      limits.advection = std::min(limits.advection, 100.0 - K);
    }

   private:
    static void name_record(Needs& n, FakeRecord record, Access access) {
      const std::string& set = fake(K).scenario;
      switch (record) {
        case FakeRecord::first:
          n.record<First<Dim>>(set, access);
          break;
        case FakeRecord::density:
          n.record<First<Dim>>(set, access, First<Dim>::density);
          break;
        case FakeRecord::pressure:
          n.record<First<Dim>>(set, access, First<Dim>::pressure);
          break;
        case FakeRecord::second:
          n.record<Second<Dim>>(set, access);
          break;
      }
    }
  };
};

}  // namespace sphgeo::test
