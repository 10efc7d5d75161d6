#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "compare/difference.h"
#include "compare/run_data.h"
#include "compare/tolerances.h"
#include "core/error.h"
#include "output/temporary_folder.h"

using namespace sphgeo;

TEST_SUITE_BEGIN("compare");

namespace {

RunData long_run() {
  RunData run;
  run.title = "long";
  run.status = "done";
  run.resolution = 0.05;
  run.steps = {{"advection", 12345}};
  ProbeCurve a{"p", "x", "m", {}, {}}, b{"p", "y", "Pa", {}, {}};
  for (int k = 0; k < 1000; ++k) {
    a.t.push_back(k / 3.0);
    a.y.push_back(k == 999 ? std::nan("") : std::sqrt(k));
    b.y.push_back(-k);
  }
  b.t = a.t;
  run.probes = {a, b};
  SetState set{"soil", 1000, {}, {{"stress.xx", {}}}};
  for (int k = 0; k < 1000; ++k) {
    set.positions.emplace_back(k, 0.5 * k, 1 / (1.0 + k));
    set.fields[0].values.push_back(std::cos(k));
  }
  run.sets = {set};
  run.ledger = {{"momentum", {{0, 1}, {2, 3}}}};
  run.results = {{"none", {{}, 0.1, false}}};
  return run;
}

}  // namespace

TEST_CASE("a baseline is small and the run that it was made of equals it") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/base.json";
  write_baseline(path, long_run(), {100, 80});
  CHECK(std::filesystem::file_size(path) < 20000);
  const RunData base = read_baseline(path);
  CHECK(base.probes.size() == 2);
  CHECK(base.probes[0].t.size() == 100);
  CHECK(base.probes[1].unit == "Pa");
  CHECK(base.probes[0].t.back() == doctest::Approx(333));
  CHECK(std::isnan(base.probes[0].y.back()));
  CHECK(base.sets[0].particles == 1000);
  CHECK(base.sets[0].positions.size() == 80);
  for (const RunDifference& d : compare_runs(long_run(), base, {})) {
    CAPTURE(d.whole_name());
    CHECK(d.pass);
    CHECK(d.difference < 1e-5);
  }
}

TEST_CASE("a run equals its baseline also where values come and go from row to row") {
  const test::TemporaryFolder folder;
  RunData run = long_run();
  for (std::size_t k = 0; k < run.probes[1].y.size(); ++k)
    if (k % 2 == 0) run.probes[1].y[k] = std::nan("");
  write_baseline(folder / "base.json", run, {100, 80});
  for (const RunDifference& d : compare_runs(run, read_baseline(folder / "base.json"), {})) {
    CAPTURE(d.whole_name());
    CHECK(d.difference < 1e-5);
  }
}

TEST_CASE("what is no baseline, or a damaged one, is refused with its path") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/base.json";
  const auto refused = [&](const std::string& text) {
    std::ofstream(path) << text;
    try {
      read_baseline(path);
    } catch (const Error& e) {
      return e.code() == ExitCode::usage && std::string(e.what()).find(path) != std::string::npos;
    }
    return false;
  };
  for (const char* text : {"", "[]", "{}", "{\"kind\": 1}", "{\"kind\": \"sphgeo baseline 1\"}",
                           "{\"kind\": \"sphgeo baseline 1\", \"title\": []}"}) {
    CAPTURE(text);
    CHECK(refused(text));
  }
  // Sound JSON whose numbers make no sense.
  write_baseline(path, long_run(), {4, 2});
  std::ifstream file(path);
  const std::string sound((std::istreambuf_iterator<char>(file)), {});
  const auto with = [&](const std::string& a, const std::string& b) {
    std::string text = sound;
    const std::size_t at = text.find(a);
    REQUIRE(at != std::string::npos);
    return text.replace(at, a.size(), b);
  };
  CHECK(refused(with("\"particles\":1000", "\"particles\":1e300")));
  CHECK(refused(with("\"particles\":1000", "\"particles\":-1")));
  CHECK(refused(with("\"t\":[0.0", "\"t\":[null")));
  CHECK(refused(with("\"x\":[", "\"x\":[null,")));
  CHECK_THROWS_AS(read_run_data(folder.path()), Error);
}

TEST_CASE("tolerances are read from a file, and a mistake in it is found with its line") {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/tolerances.yaml";
  std::ofstream(path) << "probes: 0.1\nrules:\n  - {name: field *, tolerance: 0.3}\n";
  const Tolerances t = read_tolerances(path);
  CHECK(t.of("probe", "a.b") == 0.1);
  CHECK(t.of("field", "a.b") == 0.3);
  CHECK(t.of("ledger", "mass") == Tolerances{}.ledger);
  std::ofstream(path) << "probe: 0.1\n";
  try {
    read_tolerances(path);
    FAIL("accepted");
  } catch (const DeckError& e) {
    const std::string text = e.diagnostics.render();
    CHECK(text.find(path + ":1:1") != std::string::npos);
    CHECK(text.find("did you mean 'probes'") != std::string::npos);
  }
}

TEST_SUITE_END();
