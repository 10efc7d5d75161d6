// Decks run to their end by the library alone: this program is linked without the command line.

#include "run/run_deck.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/csv_table.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/version.h"
#include "output/pvd.h"
#include "output/temporary_folder.h"
#include "relax/relax_deck.h"

using namespace sphgeo;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

constexpr double depth = 0.5, end_time = 0.05;  // m, s

const std::string pool = R"(
title: Pool
dimension: 2
resolution: 0.05
gravity: 9.81
end_time: 0.05
materials:
  - {name: water, type: water, density: 1000, sound_speed: 40}
bodies:
  - name: pool
    material: water
    shape: {type: box, min: [0, 0, 0], max: [1, 0.2, 0.5]}
    pressure: hydrostatic
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [1, 0.2, 0.7], open: [top]}
probes:
  - {name: bottom, type: pressure, at: [0.5, 0.1, 0], every: 5 ms}
output: {frames: {every: 25 ms}}
expect:
  - name: bottom_pressure
    probe: bottom.pressure
    reduce: mean
    reference: 1000 * 9.81 * 0.5
    tolerance: 2 %
    source: hydrostatics
)";

/// Keeps what it is told, and ends the run after a number of acoustic steps.
struct Listener final : RunObserver {
  long stop_after = -1;  ///< -1: never
  int begun = 0;
  std::vector<std::string> warnings, notes;
  std::vector<ProgressState> states;
  double resumed_at = -1;  ///< s
  Index resumed_steps = -1;

  void warning(const std::string& text) override { warnings.push_back(text); }
  void note(const std::string& text) override { notes.push_back(text); }
  void begins(const RunFolder&) override { ++begun; }
  void resumes(double time, Index steps, const std::string&) override {
    resumed_at = time;
    resumed_steps = steps;
  }
  void progress(const ProgressState& state) override { states.push_back(state); }
  std::string stop_reason(const RunPosition& at) override {
    return stop_after >= 0 && at.acoustic_steps >= stop_after ? "the test has seen enough" : "";
  }
};

/// What goes to the standard streams while it lives.
class Heard {
 public:
  Heard() : out_(std::cout.rdbuf(text_.rdbuf())), err_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~Heard() {
    std::cout.rdbuf(out_);
    std::cerr.rdbuf(err_);
  }
  Heard(const Heard&) = delete;
  Heard& operator=(const Heard&) = delete;
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::streambuf *out_, *err_;
};

/// One thread, as scenes of tests are small, and the number from before at the end.
class OneThread {
 public:
  OneThread() = default;
  ~OneThread() { set_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_ = threads();
};

RunSettings settings_for(const std::string& folder) {
  RunSettings settings;
  settings.deck = "pool.yaml";
  settings.folder = folder;
  settings.threads = 1;
  return settings;
}

Json summary_in(const RunFolder& folder) { return Json::parse(read_file(folder.summary())); }

ExitCode failure_of(const Model& model, const RunSettings& settings) {
  Listener listener;
  try {
    run_deck(model, settings, listener);
  } catch (const Error& e) {
    return e.code();
  }
  return ExitCode::done;
}

}  // namespace

TEST_SUITE("run") {
  TEST_CASE("a deck is run to its end, with all files of its folder, and nothing is printed") {
    const OneThread threads_kept;
    const test::TemporaryFolder here;
    const Model model = read_deck_text(pool);
    Listener listener;
    std::optional<Heard> heard(std::in_place);
    const RunResult run = run_deck(model, settings_for(here / "run"), listener);
    const std::string said = heard->text();
    heard.reset();  // what fails below is to be seen
    CHECK(said == "");

    CHECK(run.summary.status == "done");
    CHECK(run.summary.exit_code == 0);
    CHECK(run.summary.time_s >= end_time);
    CHECK(run.summary.acoustic_steps > run.summary.advection_steps);
    REQUIRE(run.summary.expect.size() == 1);
    CHECK(run.summary.expect[0].pass);
    CHECK(run.lost.empty());
    REQUIRE(run.summary.forecast);

    const Json written = summary_in(run.folder);
    CHECK(written["status"] == "done");
    CHECK(written["title"] == "Pool");
    CHECK(written["deck"] == "pool.yaml");
    CHECK(written["version"] == version());
    CHECK(written["particles"]["water"] == 200);
    CHECK(written["steps"]["acoustic"] == run.summary.acoustic_steps);
    CHECK(written["expect"][0]["pass"] == true);

    const CsvTable bottom = read_csv_table(run.folder.probe_csv("bottom"));
    const std::vector<double> time = bottom.numbers("time"), pressure = bottom.numbers("pressure");
    REQUIRE(time.size() >= 10);
    CHECK(time.front() == 0);
    CHECK(time.back() >= end_time);
    for (const double p : pressure) CHECK(p == doctest::Approx(1000 * 9.81 * depth).epsilon(0.05));
    CHECK(fs::exists(run.folder.frame("water", 2)));
    CHECK(fs::exists(run.folder.pvd("boundaries")));
    CHECK(fs::exists(run.folder.checkpoint()));
    CHECK(read_file(run.folder.resolved_deck()) == resolved_yaml(model));

    CHECK(listener.begun == 1);
    CHECK(listener.resumed_steps == -1);
    CHECK(listener.warnings.empty());
    REQUIRE(listener.states.size() == static_cast<std::size_t>(run.summary.advection_steps) + 1);
    CHECK(listener.states.front().time == 0);
    CHECK(listener.states.back().time == run.summary.time_s);
    CHECK(listener.states.back().particles == 200);
  }

  TEST_CASE("an observer ends a run, which goes on later to the same bits") {
    const OneThread threads_kept;
    const test::TemporaryFolder here;
    const Model model = read_deck_text(pool);
    Listener whole, first, second;
    const RunResult at_once = run_deck(model, settings_for(here / "whole"), whole);

    RunSettings settings = settings_for(here / "parts");
    first.stop_after = at_once.summary.acoustic_steps / 2;
    {
      const RunResult part = run_deck(model, settings, first);
      CHECK(part.summary.status == "stopped");
      CHECK(part.summary.exit_code == static_cast<int>(ExitCode::stopped));
      CHECK(part.summary.message == "the test has seen enough");
      CHECK(part.summary.acoustic_steps == first.stop_after);
      CHECK(part.summary.checkpoint.count == 1);
    }
    settings.existing = ExistingResults::resume;
    const RunResult rest = run_deck(model, settings, second);
    CHECK(second.resumed_at > 0);
    CHECK(second.resumed_at < end_time);
    CHECK(rest.summary.status == "done");
    CHECK(rest.summary.acoustic_steps == at_once.summary.acoustic_steps);
    CHECK(read_file(rest.folder.probe_csv("bottom")) ==
          read_file(at_once.folder.probe_csv("bottom")));
    CHECK(read_file(rest.folder.frame("water", 2)) == read_file(at_once.folder.frame("water", 2)));
  }

  TEST_CASE("a frame that cannot be written ends the run, and nothing later is written") {
    // Where the second frame is to be written there is a folder.
    struct InTheWay final : RunObserver {
      void begins(const RunFolder& folder) override {
        fs::create_directory(folder.frame("water", 1) + ".part");
      }
    } observer;
    const OneThread threads_kept;
    const test::TemporaryFolder here;
    const Model model = read_deck_text(pool);
    try {
      run_deck(model, settings_for(here / "run"), observer);
      FAIL_CHECK("the run did not notice");
    } catch (const IoError& e) {
      CHECK(std::string(e.what()).find("water_000001.vtu") != std::string::npos);
    }
    const RunFolder folder(here / "run", ExistingResults::resume);
    CHECK(fs::exists(folder.frame("water", 0)));
    CHECK_FALSE(fs::exists(folder.frame("water", 2)));
    CHECK(PvdFile::read(folder.pvd("water")).frames().size() == 1);
    CHECK_FALSE(fs::exists(folder.checkpoint()));
    CHECK_FALSE(fs::exists(folder.summary()));
  }

  TEST_CASE("a folder is refused that holds results, or that another run holds") {
    const OneThread threads_kept;
    const test::TemporaryFolder here;
    const Model model = read_deck_text(pool, {"end_time=0.01"});
    RunSettings settings = settings_for(here / "run");
    Listener listener;
    {
      const RunResult run = run_deck(model, settings, listener);
      settings.existing = ExistingResults::overwrite;
      CHECK(failure_of(model, settings) == ExitCode::usage);  // the result still holds it
    }
    settings.existing = ExistingResults::refuse;
    CHECK(failure_of(model, settings) == ExitCode::usage);
    settings.existing = ExistingResults::overwrite;
    CHECK(failure_of(model, settings) == ExitCode::done);
    settings.existing = ExistingResults::resume;
    const Model other = read_deck_text(pool, {"resolution=0.1"});
    CHECK_THROWS_AS(run_deck(other, settings, listener), DeckError);
  }

  TEST_CASE("a resumed run without a checkpoint starts anew, and says so") {
    const OneThread threads_kept;
    const test::TemporaryFolder here;
    const Model model = read_deck_text(pool, {"end_time=0.01"});
    RunSettings settings = settings_for(here / "run");
    Listener listener;
    run_deck(model, settings, listener);
    fs::remove(here / "run/checkpoint.h5");
    settings.existing = ExistingResults::resume;
    const RunResult run = run_deck(model, settings, listener);
    CHECK(run.summary.status == "done");
    REQUIRE(listener.warnings.size() == 1);
    CHECK(listener.warnings[0].find("holds no checkpoint yet") != std::string::npos);
    CHECK(listener.resumed_steps == -1);
  }

  TEST_CASE("an unstable run and a missed claim are told by the summary, not thrown") {
    const OneThread threads_kept;
    const test::TemporaryFolder here;
    Listener listener;
    const RunResult unstable = run_deck(read_deck_text(pool, {"bodies[0].velocity=[200, 0, 0]"}),
                                        settings_for(here / "unstable"), listener);
    CHECK(unstable.summary.status == "unstable");
    CHECK(unstable.summary.exit_code == static_cast<int>(ExitCode::unstable));
    CHECK(unstable.summary.guard.tripped);
    CHECK(unstable.summary.message == unstable.summary.guard.reason);

    RunSettings settings = settings_for(here / "missed");
    settings.verify = true;
    const RunResult missed = run_deck(
        read_deck_text(pool, {"end_time=0.01", "expect[0].reference=1"}), settings, listener);
    CHECK(missed.summary.status == "done");
    CHECK(missed.summary.exit_code == static_cast<int>(ExitCode::mismatch));
  }

  TEST_CASE("a relaxation writes its folder") {
    const OneThread threads_kept;
    const test::TemporaryFolder here;
    const std::string bed = R"(
dimension: 2
resolution: 0.05
end_time: 1
materials:
  - {name: water, type: water}
  - name: sand
    type: soil
    density: 2600
    volume_fraction: 0.6
    youngs_modulus: 1 MPa
    friction_angle: 30 deg
bodies:
  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [1, 0.2, 0.5]}}
  - {name: bed, material: sand, shape: {type: box, min: [0, 0, 0], max: [1, 0.2, 0.3]}}
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [1, 0.2, 0.7], open: [top]}
)";
    Listener listener;
    const RelaxResult done =
        relax_deck(read_deck_text(bed), settings_for(here / "relaxed"), listener);
    const RunFolder folder(here / "relaxed", ExistingResults::resume);
    CHECK(done.water.accepted > 100);
    CHECK(fs::exists(folder.relaxed()));
    CHECK(fs::exists(folder.frame("water", 1)));
    const Json written = summary_in(folder);
    CHECK(written["relaxation"]["particles"] == done.water.accepted);
    CHECK(written["particles"]["water"] == done.water.accepted);
    CHECK_THROWS_AS(relax_deck(read_deck_text(pool), settings_for(here / "none"), listener), Error);
  }
}
