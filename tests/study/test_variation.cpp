#include "study/variation.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/error.h"

using namespace sphgeo;

TEST_SUITE_BEGIN("study");

TEST_CASE("values are split at commas that stand outside of brackets and quotes") {
  CHECK(parse_variation("resolution=0.04, 0.02").values ==
        std::vector<std::string>{"0.04", "0.02"});
  CHECK(parse_variation("gravity=[0, 0, -1],[0, 0, -2]").values ==
        std::vector<std::string>{"[0, 0, -1]", "[0, 0, -2]"});
  CHECK(parse_variation("dp=min(1, 2),\"3, 4\"").values ==
        std::vector<std::string>{"min(1, 2)", "\"3, 4\""});
  CHECK(parse_variation("a.b[0].c=x").key == "a.b[0].c");
}

TEST_CASE("what is no variation is refused as a mistake of usage") {
  for (const char* text : {"", "resolution", "=1", "a=", "a=1,,2", "a=1,1", "a=[1,2", "a='1"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_variation(text), Error);
  }
}

TEST_CASE("one key at a time is a curve a key; all combinations share runs with nobody") {
  const std::vector<Variation> two = {{"dp", {"4", "2", "1"}}, {"h", {"1.3", "1.8"}}};
  const StudyDesign one = one_at_a_time(two);
  CHECK(one.runs.size() == 5);
  REQUIRE(one.curves.size() == 2);
  CHECK(one.curves[1].runs == std::vector<std::size_t>{3, 4});
  const StudyDesign all = all_combinations(two);
  CHECK(all.runs.size() == 6);
  REQUIRE(all.curves.size() == 2);
  CHECK(settings_text(all.curves[1].others) == "h=1.8");
  CHECK(settings_text(all.runs[all.curves[1].runs[2]]) == "dp=1 h=1.8");
}

TEST_SUITE_END();
