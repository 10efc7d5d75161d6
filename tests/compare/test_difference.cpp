#include "compare/difference.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace sphgeo;

TEST_SUITE_BEGIN("compare");

namespace {

RunData some_run() {
  RunData run;
  run.title = "a run";
  run.status = "done";
  run.resolution = 0.1;
  run.steps = {{"advection", 100}, {"acoustic", 600}};
  ProbeCurve curve{"gauge", "level", "m", {}, {}};
  for (int k = 0; k <= 100; ++k) {
    curve.t.push_back(0.01 * k);
    curve.y.push_back(1 + std::sin(0.1 * k));
  }
  run.probes = {curve};
  SetState set{"water", 50, {}, {{"pressure", {}}}};
  for (int k = 0; k < 50; ++k) {
    set.positions.emplace_back(0.1 * k, 0, 0);
    set.fields[0].values.push_back(100 * k);
  }
  run.sets = {set};
  run.ledger = {{"mass", {{50}, {50}}}, {"momentum", {{0, 0, 0}, {1, 0, 0}}}};
  run.results = {{"depth", {0.5, 0.02, true}}};
  return run;
}

const RunDifference& find(const std::vector<RunDifference>& all, const std::string& name) {
  const auto at = std::find_if(all.begin(), all.end(),
                               [&](const RunDifference& d) { return d.whole_name() == name; });
  REQUIRE(at != all.end());
  return *at;
}

bool all_pass(const std::vector<RunDifference>& all) {
  return std::all_of(all.begin(), all.end(), [](const RunDifference& d) { return d.pass; });
}

}  // namespace

TEST_CASE("a run equals itself, whatever the tolerances") {
  Tolerances none{0, 0, 0, 0, 0, 0, 0, {}};
  const auto all = compare_runs(some_run(), some_run(), none);
  CHECK(all.size() == 10);
  CHECK(all_pass(all));
}

TEST_CASE("a curve's difference is its root mean square by its range") {
  RunData run = some_run();
  for (double& y : run.probes[0].y) y += 0.1;
  const auto all = compare_runs(run, some_run(), {});
  const RunDifference& d = find(all, "probe gauge.level");
  // The curve spans from its trough at t = 1, 1 + sin 10, to 2.
  CHECK(d.difference ==
        doctest::Approx(0.1 / (1 - std::sin(3 * std::acos(-1.0) / 2))).epsilon(0.001));
  CHECK_FALSE(d.pass);
  CHECK(all.front().whole_name() == "probe gauge.level");  // the worst comes first
}

TEST_CASE("curves sampled at other times are compared by interpolation, gaps are told") {
  RunData run = some_run();
  ProbeCurve& curve = run.probes[0];
  for (std::size_t k = 0; k < curve.t.size(); ++k) {
    curve.t[k] += 0.003;
    curve.y[k] = 1 + std::sin(10 * curve.t[k]);
  }
  // Before its first sample the curve is held: 0.03 in one of 101 rows.
  CHECK(find(compare_runs(run, some_run(), {}), "probe gauge.level").difference < 2e-3);
  for (std::size_t k = 40; k < 60; ++k) curve.y[k] = std::nan("");
  const auto all = compare_runs(run, some_run(), {});
  CHECK(find(all, "probe gauge.level").difference == doctest::Approx(0.2).epsilon(0.15));
}

TEST_CASE("fields are compared at the nearest particle, whatever the order of particles") {
  RunData run = some_run();
  std::reverse(run.sets[0].positions.begin(), run.sets[0].positions.end());
  std::reverse(run.sets[0].fields[0].values.begin(), run.sets[0].fields[0].values.end());
  CHECK(all_pass(compare_runs(run, some_run(), {0, 0, 0, 0, 0, 0, 0, {}})));
  for (double& p : run.sets[0].fields[0].values) p += 49;
  const auto all = compare_runs(run, some_run(), {});
  CHECK(find(all, "field water.pressure").difference == doctest::Approx(0.01));
  for (Vec3& x : run.sets[0].positions) x.z() += 0.02;
  CHECK(find(compare_runs(run, some_run(), {}), "positions water").difference ==
        doctest::Approx(0.2));
}

TEST_CASE("noise about zero beside a signal is measured by a hundredth of the signal") {
  RunData run = some_run(), base = some_run();
  for (RunData* data : {&run, &base}) {
    ProbeCurve noise = data->probes[0];
    noise.column = "noise";
    for (double& y : noise.y) y = data == &run ? 1e-5 : -1e-5 * y;
    data->probes.push_back(noise);
    data->sets[0].fields = {{"velocity.x", data->sets[0].fields[0].values},
                            {"velocity.z", std::vector<double>(50, 0)}};
    data->sets[0].fields[1].values[7] = data == &run ? 1e-3 : 2e-3;
  }
  CHECK(all_pass(compare_runs(run, base, {})));
  run.probes[1].y.assign(101, 0.1);
  CHECK_FALSE(find(compare_runs(run, base, {}), "probe gauge.noise").pass);
}

TEST_CASE("lost particles, another end, another ledger and a result that now fails are findings") {
  RunData run = some_run();
  run.status = "unstable";
  run.sets[0].positions.pop_back();
  run.sets[0].fields[0].values.pop_back();
  run.sets[0].particles = 49;
  run.ledger[0].second.final = {49};
  run.results[0].second = {0.5, 0.02, false};
  const auto all = compare_runs(run, some_run(), {});
  for (const char* name : {"status", "particles water", "ledger mass", "result depth"}) {
    CAPTURE(name);
    CHECK_FALSE(find(all, name).pass);
  }
  CHECK(find(all, "ledger mass").difference == doctest::Approx(0.02));
}

TEST_CASE(
    "a result that met its tolerance and misses it now fails whatever the tolerances, and so does "
    "a ledger that is no number") {
  const Tolerances wide{1e9, 1e9, 1e9, 1e9, 0, 1e9, 1e9, {{"*", 1e300}}};
  RunData run = some_run();
  run.results[0].second.pass = false;
  CHECK_FALSE(find(compare_runs(run, some_run(), wide), "result depth").pass);
  run = some_run();
  run.results[0].second.value.reset();
  CHECK_FALSE(find(compare_runs(run, some_run(), wide), "result depth").pass);
  run = some_run();
  run.ledger[0].second.final = {std::nan("")};
  CHECK_FALSE(find(compare_runs(run, some_run(), {}), "ledger mass").pass);
}

TEST_CASE("what the run lacks fails, what it has more is told") {
  RunData run = some_run(), base = some_run();
  run.probes[0].probe = "other";
  const auto all = compare_runs(run, base, {});
  CHECK_FALSE(find(all, "missing probe gauge.level").pass);
  CHECK(find(all, "new probe other.level").pass);
}

TEST_CASE("the last rule that fits decides on a tolerance") {
  Tolerances t;
  t.rules = {{"probe gauge.*", 0.5}, {"probe gauge.level", 0.25}, {"field *", 0.75}};
  CHECK(t.of("probe", "gauge.level") == 0.25);
  CHECK(t.of("probe", "gauge.speed") == 0.5);
  CHECK(t.of("field", "water.velocity.x") == 0.75);
  CHECK(t.of("ledger", "mass") == t.ledger);
}

TEST_SUITE_END();
