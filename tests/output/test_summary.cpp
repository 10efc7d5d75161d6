#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "output/progress.h"
#include "output/summary.h"
#include "output/time_table.h"
#include "temporary_folder.h"

using namespace sphgeo;

TEST_SUITE("output") {
  TEST_CASE("the time table adds up to the wall time") {
    // On two threads; the wall time, the processors' and what the threads had.
    const auto spent = [](double seconds, double processor) {
      return Spent{.seconds = seconds, .processor = processor, .offered = 2 * seconds};
    };
    const std::vector<TimeRow> rows = with_rest(
        {{"b", 4, spent(1, 2)}, {"a", 2, spent(1, 1)}, {"never", 0, {}}, {"big", 8, spent(6, 9)}},
        spent(10, 15));
    REQUIRE(rows.size() == 4);
    CHECK(rows[0].name == "big");
    CHECK(rows[1].name == "a");
    CHECK(rows[3].name == "rest");
    CHECK(rows[3].spent.seconds == 2);
    double share = 0;
    for (const TimeRow& r : rows) share += r.share;
    CHECK(share == doctest::Approx(1));
    CHECK(render_time_table(rows) ==
          "  effect       calls     seconds    share     busy\n"
          "  big              8       6.000   60.0 %   75.0 %\n"
          "  a                2       1.000   10.0 %   50.0 %\n"
          "  b                4       1.000   10.0 %  100.0 %\n"
          "  rest                     2.000   20.0 %   75.0 %\n"
          "  total                   10.000  100.0 %   75.0 %\n");
    CHECK(with_rest({}, {}).size() == 1);
  }

  TEST_CASE("summary.json has every promised key, and null for what is not finite") {
    Summary s;
    s.status = "unstable";
    s.version = "0.1.0";
    s.deck_hash = "abc";
    s.threads = 2;
    s.particles = {{"water", 100}, {"tank", 50}};
    s.advection_steps = 3;
    s.acoustic_steps = 12;
    s.time_s = 0.25;
    s.particle_updates_per_s_per_core = std::nan("");
    s.effects = with_rest({{"density", 12, {1, 1}}}, {2, 2});
    ExpectResult e;
    e.name = "level";
    e.reference = 1;
    e.tolerance = 0.01;
    e.note = "no probe \xff";  // bytes that are no UTF-8 must not lose the summary
    s.expect = {e};
    s.ledger = {{"mass", "kg", {10}, {10}, {}, 0},
                {"momentum", "kg m/s", {0, 0, 0}, {1, 2, INFINITY}, {1, 2, 3}, 0.5}};
    s.guard.tripped = true;
    s.guard.reason = "not a number";
    s.guard.particle = 7;
    s.guard.place = Vec3(1, 2, 3);
    s.guard.extremes = {{"max_speed", 4}};

    const test::TemporaryFolder folder;
    write_summary(folder / "summary.json", s);
    const auto j = nlohmann::json::parse(read_file(folder / "summary.json"));
    CHECK(j["status"] == "unstable");
    CHECK(j["particles"]["tank"] == 50);
    CHECK(j["steps"] == nlohmann::json{{"advection", 3}, {"acoustic", 12}, {"solid", 0}});
    CHECK(j["time_s"] == 0.25);
    CHECK(j["particle_updates_per_s_per_core"].is_null());
    CHECK(j["effects"][1]["name"] == "rest");
    CHECK(j["effects"][1]["share"] == 0.5);
    CHECK(j["expect"][0]["value"].is_null());
    CHECK(j["expect"][0]["pass"] == false);
    CHECK(j["ledger"]["mass"]["final"] == 10);
    CHECK(j["ledger"]["momentum"]["final"][1] == 2);
    CHECK(j["ledger"]["momentum"]["final"][2].is_null());
    CHECK(j["guard"]["particle"] == 7);
    CHECK(j["guard"]["position"][2] == 3);
    CHECK(j["guard"]["max_speed"] == 4);
    for (const char* key : {"version", "deck_hash", "threads", "wall_s", "memory_peak_bytes"})
      CHECK(j.contains(key));
    CHECK_THROWS_AS(write_summary("/dev/full", s), IoError);
    CHECK(peak_memory_bytes() > 1000000);
  }

  TEST_CASE("progress is one plain line a report when there is no terminal") {
    std::ostringstream out;
    Progress progress(out, {});
    ProgressState s{0, 2, 0, 0, 1e-4, 1000, 0};
    progress.update(s);
    s = {0.5, 2, 10, 40, 1e-4, 1000, 10};
    progress.update(s);
    CHECK(out.str().empty());
    progress.report(s, "frame 3");
    CHECK(out.str() ==
          "t = 0.5000 s of 2 s (25 %)  steps 10/40  dt 0.0001 s  0.004 M updates/s  30 s left  "
          "frame 3\n");
    s.wall_s = 71;
    progress.update(s);  // a minute without a report
    const std::string all = out.str();
    CHECK(all.find('\x1b') == std::string::npos);
    CHECK(std::count(all.begin(), all.end(), '\n') == 2);
  }

  TEST_CASE("on a terminal a bar rewrites its line and makes way for reports") {
    std::ostringstream out;
    Progress progress(out, {true, false, false});
    progress.update({0, 2, 0, 0, 1e-4, 1000, 0});
    progress.update({1, 2, 0, 0, 1e-4, 1000, 0.1});  // too soon to draw again
    CHECK(out.str() == "\r[                              ]   0.0 %  t = 0 s  0 steps  \x1b[K");
    out.str("");
    progress.update({1, 2, 5, 20, 1e-4, 1000, 1});
    CHECK(out.str() ==
          "\r[===============               ]  50.0 %  t = 1 s  20 steps  1 s left\x1b[K");
    out.str("");
    progress.report({2, 2, 9, 40, 1e-4, 1000, 2});
    CHECK(out.str().substr(0, 8) == "\r\x1b[Kt = ");
    CHECK(out.str().find("done\n") != std::string::npos);
    out.str("");
    Progress colored(out, {true, true, false});
    colored.update({0, 2, 0, 0, 1e-4, 1000, 0});
    CHECK(out.str().find("\x1b[32m") != std::string::npos);
    out.str("");
    Progress quiet(out, {true, true, true});
    quiet.update({0, 2, 0, 0, 1e-4, 1000, 0});
    quiet.report({1, 2, 0, 0, 1e-4, 1000, 9});
    CHECK(out.str().empty());
  }

  TEST_CASE("durations are told in two units at most") {
    CHECK(duration_text(0.4) == "0 s");
    CHECK(duration_text(59.6) == "1 min 00 s");
    CHECK(duration_text(200) == "3 min 20 s");
    CHECK(duration_text(7500) == "2 h 05 min");
    CHECK(duration_text(3 * 86400 + 4 * 3600) == "3 d 4 h");
    CHECK(duration_text(INFINITY) == "unknown");
  }
}
