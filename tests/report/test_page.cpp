#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "output/pvd.h"
#include "output/temporary_folder.h"
#include "output/vtu.h"
#include "report/page.h"
#include "report/scene_pictures.h"

using namespace sphgeo;

namespace {

std::size_t occurrences(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size()))
    ++n;
  return n;
}

/// A run folder with everything that the page shows, made by hand.
void make_run(const std::string& folder, double speed, const std::string& title = "A dam") {
  std::filesystem::create_directories(folder + "/frames");
  std::filesystem::create_directories(folder + "/probes");
  nlohmann::ordered_json summary = {
      {"status", "done"},
      {"version", "0.0.1"},
      {"title", title},
      {"dimension", 2},
      {"threads", 2},
      {"particles", {{"water", 400}}},
      {"steps", {{"advection", 12}, {"acoustic", 3456}, {"solid", 0}}},
      {"time_s", 1.5},
      {"wall_s", 12.25},
      {"memory_peak_bytes", 25'300'000},
      {"effects", {{{"name", "water_kick"}, {"calls", 3456}, {"seconds", 10.0}, {"share", 0.8}}}},
      {"plan",
       {{{"stage", "kick"},
         {"name", "water_kick"},
         {"equations", "Eq. 1"},
         {"acts_on", "water"},
         {"because", "there is <water>"}}}},
      {"expect",
       {{{"name", "front"},
         {"value", 0.75},
         {"reference", 0.8},
         {"error", 0.0625},
         {"tolerance", 0.1},
         {"pass", true}}}},
      {"ledger",
       {{"mass", {{"unit", "kg"}, {"initial", 10.0}, {"final", 10.0}, {"relative_error", 0.0}}}}},
      {"guard", {{"tripped", false}, {"max_mach", 0.098}}}};
  write_file_atomically(folder + "/summary.json", summary.dump());
  write_file_atomically(folder + "/probes/front.csv",
                        "# sphgeo: front\ntime [s],position [m]\n0,0.5\n1.5,0.75\n");
  write_file_atomically(folder + "/run.csv",
                        "# sphgeo: run\ntime [s],kinetic [J],potential [J]\n0,0,5\n1.5,2,3\n");
  PvdFile pvd(folder + "/frames/water.pvd");
  for (int k = 0; k < 3; ++k) {
    std::vector<Vec3> points;
    std::vector<double> velocity;
    for (int i = 0; i < 400; ++i) {
      points.emplace_back(0.05 * (i % 20), 0, 0.05 * (i / 20));
      for (const double v : {speed * k * i / 400, 0.0, 0.0}) velocity.push_back(v);
    }
    const std::string name = "water_" + std::to_string(k) + ".vtu";
    write_vtu(folder + "/frames/" + name, points,
              {{"velocity", "m/s", 3, std::span<const double>(velocity)}});
    pvd.add(0.75 * k, name);
  }
}

}  // namespace

TEST_SUITE("report") {
  TEST_CASE("a page is one file that asks for nothing else, with the numbers of the summary") {
    const test::TemporaryFolder folder;
    make_run(folder.path(), 2);
    const std::string page = report_page(read_runs({folder.path()}));
    CHECK(page.starts_with("<!DOCTYPE html>"));
    CHECK(page.find("src=\"http") == std::string::npos);
    CHECK(page.find("href=") == std::string::npos);
    CHECK(page.find("url(") == std::string::npos);
    CHECK(page.find("@import") == std::string::npos);
    CHECK(page.find("prefers-color-scheme: dark") != std::string::npos);
    CHECK(page.find("name=\"viewport\"") != std::string::npos);
    CHECK(occurrences(page, "<script") == 1);
    CHECK(page.find("<script type=\"application/json\" id=\"summary\">{\"status\":\"done\"") !=
          std::string::npos);
    CHECK(page.find("<span data-path=\"/steps/acoustic\">3\u202f456</span>") != std::string::npos);
    CHECK(page.find("data-path=\"/expect/0/value\">0.75<") != std::string::npos);
    CHECK(page.find("1 of 1 expectation met") != std::string::npos);
    CHECK(page.find("there is &lt;water&gt;") != std::string::npos);
    CHECK(occurrences(page, "data:image/png;base64,") == 3);
    CHECK(occurrences(page, "<svg class=\"chart\"") >= 2);
    CHECK(page.size() < most_page_bytes);
  }

  TEST_CASE("several runs share charts and colours, and each has its column") {
    const test::TemporaryFolder folder;
    make_run(folder / "one", 2);
    make_run(folder / "two", 4);
    const auto runs = read_runs({folder / "one", folder / "two"});
    CHECK(runs[0].label == "one");
    const std::string page = report_page(runs);
    CHECK(page.find("id=\"summary-2\"") != std::string::npos);
    CHECK(occurrences(page, "data:image/png;base64,") == 6);
    CHECK(page.find("data-path=\"/expect/0/value\" data-run=\"2\">") != std::string::npos);
    const ScenePictures pictures = paint_runs(runs);
    REQUIRE(pictures.rows.size() == 1);
    CHECK(pictures.rows[0].title == "Speed");
    CHECK(pictures.rows[0].low == 0);
    CHECK(pictures.rows[0].high > 4);
    CHECK(pictures.rows[0].high <= 8);
    REQUIRE(pictures.rows[0].shots.size() == 2);
    for (const auto& run : pictures.rows[0].shots)
      for (const auto& shot : run) CHECK(shot.has_value());
    // Runs of one name are told apart by their folders.
    make_run(folder / "other/one", 2);
    CHECK(read_runs({folder / "one", folder / "other/one"})[1].label == folder / "other/one");
  }

  TEST_CASE("pictures shrink until they fit") {
    const test::TemporaryFolder folder;
    make_run(folder.path(), 2);
    const auto runs = read_runs({folder.path()});
    PictureWishes wishes;
    const std::size_t usual = paint_runs(runs, wishes).bytes();
    wishes.most_bytes = usual / 2;
    const ScenePictures small = paint_runs(runs, wishes);
    CHECK(small.bytes() <= wishes.most_bytes);
    CHECK(small.rows[0].shots[0][2].has_value());
  }

  TEST_CASE("nothing that a deck says becomes markup") {
    const test::TemporaryFolder folder;
    const std::string evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)>";
    make_run(folder.path(), 2, evil);
    std::ofstream(folder / "resolved.yaml") << "title: \"" << evil << "\"\n</pre>" << evil;
    const std::string page = report_page(read_runs({folder.path()}));
    CHECK(occurrences(page, "<script") == 1);
    CHECK(occurrences(page, "</script>") == 1);
    CHECK(page.find("<img src=x") == std::string::npos);
    CHECK(occurrences(page, "</pre>") == 1);
    // A deck that cannot be read is said to be so, and the rest is there.
    CHECK(page.find("resolved.yaml cannot be read") != std::string::npos);
    CHECK(occurrences(page, "data:image/png;base64,") == 3);
  }

  TEST_CASE("what is missing or damaged is named, and the rest is there") {
    const test::TemporaryFolder folder;
    make_run(folder.path(), 2);
    std::ofstream(folder / "frames/water_1.vtu") << "nonsense";
    std::ofstream(folder / "run.csv") << "time [s],kinetic [J]\n0,abc\n";
    std::string page = report_page(read_runs({folder.path()}));
    CHECK(page.find("water_1.vtu") != std::string::npos);
    CHECK(page.find("run.csv") != std::string::npos);
    CHECK(page.find("1 of 1 expectation met") != std::string::npos);
    for (const std::string& damaged :
         {std::string("{\"status\": 7, \"expect\": 3, \"effects\": {\"a\": 1}, \"ledger\": [1], "
                      "\"guard\": \"x\", \"plan\": [3], \"particles\": [2]}"),
          std::string("[]"), std::string("{"), std::string("null")}) {
      std::ofstream(folder / "summary.json") << damaged;
      page = report_page(read_runs({folder.path()}));
      CHECK(page.ends_with("</html>\n"));
    }
    CHECK_THROWS_AS(read_run(folder / "nowhere"), IoError);
    CHECK_THROWS_AS(write_report({folder.path()}, folder / "no/such/folder.html"), IoError);
  }

  TEST_CASE("an unstable run says where and why") {
    const test::TemporaryFolder folder;
    make_run(folder.path(), 2);
    auto summary = nlohmann::ordered_json::parse(read_file(folder / "summary.json"));
    summary["status"] = "unstable";
    summary["message"] = "set 'water' became unstable";
    summary["guard"] = {{"tripped", true},   {"cause", "speed"}, {"effect", "water_kick"},
                        {"set", "water"},    {"particle", 262},  {"position", {1.012, 0.0, 0.3533}},
                        {"time_s", 0.916062}};
    write_file_atomically(folder / "summary.json", summary.dump());
    const std::string page = report_page(read_runs({folder.path()}));
    CHECK(page.find("class=\"badge bad\">unstable") != std::string::npos);
    CHECK(page.find("set &#39;water&#39; became unstable") != std::string::npos);
    CHECK(page.find("particle <strong>262</strong>") != std::string::npos);
    CHECK(page.find("(1.012, 0, 0.3533) m") != std::string::npos);
  }
}
