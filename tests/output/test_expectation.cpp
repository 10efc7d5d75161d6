#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "core/atomic_file.h"
#include "core/csv_table.h"
#include "deck/model.h"
#include "output/expectation.h"
#include "output/reduction.h"
#include "output/series.h"
#include "temporary_folder.h"

using namespace sphgeo;
using std::numbers::pi;

namespace {

const double not_a_number = std::nan("");

/// n + 1 samples of a function at slightly irregular times from 0 to end.
template <class F>
Samples sampled(int n, double end, F f) {
  Samples s;
  for (int i = 0; i <= n; ++i) {
    const double shift = i == 0 || i == n ? 0 : 0.3 * std::sin(12.9898 * i);
    s.t.push_back(end * (i + shift) / n);
    s.y.push_back(f(s.t.back()));
  }
  return s;
}

double value_of(const Samples& s, const char* name, std::optional<double> at = {}) {
  return sphgeo::reduce(s, name, at).value_or(-999);
}

}  // namespace

TEST_SUITE("output") {
  TEST_CASE("reductions of a line against closed forms") {
    const Samples s = sampled(50, 4, [](double t) { return 3 * t - 2; });
    CHECK(value_of(s, "last") == doctest::Approx(10));
    CHECK(value_of(s, "first") == doctest::Approx(-2));
    CHECK(value_of(s, "min") == doctest::Approx(-2));
    CHECK(value_of(s, "max") == doctest::Approx(10));
    CHECK(value_of(s, "max_abs") == doctest::Approx(10));
    CHECK(value_of(s, "range") == doctest::Approx(12));
    CHECK(value_of(s, "mean") == doctest::Approx(4));
    CHECK(value_of(s, "rms") == doctest::Approx(std::sqrt(28.0)));  // integral of (3t-2)^2 over 4
    CHECK(value_of(s, "growth") == doctest::Approx(12));
    CHECK(value_of({{0, 1, 2, 3}, {5, 1, 4, 2}}, "growth") == 3);
    CHECK(value_of({{0, 1, 2}, {5, 4, 2}}, "growth") == 0);
    CHECK(value_of(s, "slope") == doctest::Approx(3));
    CHECK(value_of(s, "time_of_max") == doctest::Approx(4));
    CHECK(value_of(s, "time_of_min") == doctest::Approx(0));
    CHECK(value_of(s, "at", 1.2345) == doctest::Approx(3 * 1.2345 - 2));
    CHECK_FALSE(sphgeo::reduce(s, "at", 4.1));
    CHECK_FALSE(sphgeo::reduce(s, "at"));
    CHECK_FALSE(sphgeo::reduce(s, "period"));
    CHECK_THROWS_AS(sphgeo::reduce(s, "median"), std::invalid_argument);
    CHECK_THROWS_AS(sphgeo::reduce({}, "median"), std::invalid_argument);
    for (const std::string_view name : reduction_names()) CHECK_FALSE(sphgeo::reduce({}, name, 0));
    CHECK(value_of({{1}, {5}}, "mean") == 5);
    CHECK_FALSE(sphgeo::reduce({{1}, {5}}, "slope"));
  }

  TEST_CASE("a window cuts between samples, and samples without support are left out") {
    const std::vector<double> t = {0, 1, 2, 3}, y = {0, not_a_number, 4, 9};
    CHECK(cut(t, y, {}, {}).t == std::vector<double>{0, 2, 3});
    const Samples s = cut(t, y, 1, 2.5);
    CHECK(s.t == std::vector<double>{1, 2, 2.5});
    CHECK(s.y == std::vector<double>{2, 4, 6.5});
    CHECK(cut(t, y, 2, 2).t == std::vector<double>{2});
    CHECK(cut(t, y, -5, 99).t.size() == 3);
    CHECK(cut(t, y, 4, 5).t.empty());
    CHECK(cut(t, y, 3, 1).t.empty());
  }

  TEST_CASE("the period of pure, offset, drifting, damped and noisy oscillations") {
    for (const double phase : {0.0, 0.7, pi / 2, 2.5})
      for (const double periods : {2.2, 3.6, 5.0, 9.5}) {
        CAPTURE(phase);
        CAPTURE(periods);
        const double period = 1.13392;
        const double w = 2 * pi / period;
        const double end = periods * period;
        const auto wave = [&](double t) { return std::cos(w * t + phase); };
        const int n = 40 * static_cast<int>(periods + 1);
        CHECK(value_of(sampled(n, end, wave), "period") == doctest::Approx(period).epsilon(2e-3));
        CHECK(value_of(sampled(n, end, [&](double t) { return 40 + 0.01 * wave(t); }), "period") ==
              doctest::Approx(period).epsilon(2e-3));
        if (periods < 3) continue;  // fewer do not tell a trend or a decay from the wave
        CHECK(value_of(sampled(n, end, [&](double t) { return wave(t) + 0.5 * t; }), "period") ==
              doctest::Approx(period).epsilon(5e-3));
        CHECK(value_of(sampled(n, end, [&](double t) { return std::exp(-0.15 * t) * wave(t); }),
                       "period") == doctest::Approx(period).epsilon(5e-3));
        const Samples noisy = sampled(n, end, [&](double t) {
          return wave(t) + 0.08 * std::sin(977 * t) + 0.05 * std::cos(2311 * t * t);
        });
        CHECK(value_of(noisy, "period") == doctest::Approx(period).epsilon(2e-2));
        CHECK(value_of(noisy, "frequency") == doctest::Approx(1 / value_of(noisy, "period")));
      }
    CHECK_FALSE(
        sphgeo::reduce(sampled(40, 0.7, [](double t) { return std::sin(2 * pi * t); }), "period"));
    CHECK_FALSE(sphgeo::reduce(sampled(40, 1, [](double) { return 1; }), "period"));
  }

  TEST_CASE("the difference of curves") {
    const Samples s = sampled(10, 2, [](double t) { return t; });
    const std::vector<double> x = {0, 0.5, 1, 1.5, not_a_number, 3}, y = {0, 0.6, 0.9, 1.5, 7, 2};
    const CurveDifference d = compare_curve(s, x, y).value();
    CHECK(d.used == 4);
    CHECK(d.skipped == 1);
    CHECK(d.max == doctest::Approx(0.1 / 2));
    CHECK(d.l2 == doctest::Approx(std::sqrt(0.02 / 4) / 2));
    CHECK_FALSE(compare_curve({}, x, y));
    const std::vector<double> constant{1, 1};
    const CurveDifference flat = compare_curve(s, std::vector<double>{0, 1}, constant).value();
    CHECK(std::isfinite(flat.relative_l2));
    CHECK_FALSE(std::isfinite(flat.l2));
  }

  TEST_CASE("claims of a deck are measured and judged") {
    Series gauge("gauge.left", {{"level", "m", ""}, {"p", "Pa", ""}});
    for (int i = 0; i <= 20; ++i)
      gauge.add(0.1 * i, std::vector<double>{0.05 * i, i < 10 ? not_a_number : 1000 + i});
    const SeriesLookup lookup = [&](const std::string& name) {
      return name == "gauge.left" ? &gauge : nullptr;
    };
    Expect e;
    e.name = "level";
    e.probe = "gauge.left";
    e.reference = 0.98;
    e.tolerance = 0.03;
    ExpectResult r = evaluate(e, lookup);
    CHECK(r.value.value() == doctest::Approx(1));
    CHECK(r.error.value() == doctest::Approx(0.02 / 0.98));
    CHECK(r.pass);
    e.tolerance_kind = "absolute";
    e.tolerance = 0.019;
    r = evaluate(e, lookup);
    CHECK(r.error.value() == doctest::Approx(0.02));
    CHECK_FALSE(r.pass);
    e.scale = 1 / 0.98;
    CHECK(evaluate(e, lookup).pass);

    SUBCASE("bounds, columns and windows") {
      Expect b;
      b.name = "pressure";
      b.probe = "gauge.left.p";
      b.reduce = "max";
      b.to = 1.5;
      b.measure = "below";
      b.tolerance = 1015;
      CHECK(evaluate(b, lookup).pass);
      b.tolerance = 1014;
      CHECK_FALSE(evaluate(b, lookup).pass);
      b.measure = "above";
      CHECK(evaluate(b, lookup).pass);
      b.to = 0.5;  // no support there
      r = evaluate(b, lookup);
      CHECK_FALSE(r.pass);
      CHECK_FALSE(r.value);
      CHECK(r.note == "the 0 samples hold no 'max'");
    }
    SUBCASE("curves") {
      const test::TemporaryFolder folder;
      write_file_atomically(folder / "ref.csv", "T,Z\n0,0\n1,10\n2,22\n9,90\n");
      Expect c;
      c.name = "curve";
      c.probe = "gauge.left.level";
      c.reduce = "curve";
      c.reference_csv = FilePath{folder / "ref.csv"};
      c.y_scale = 0.05;  // Z = 10 t
      c.x_scale = 1;
      c.to = 2;  // the far point is left out, of the range too
      c.tolerance = 0.06;
      r = evaluate(c, lookup);
      CHECK(r.value.value() == doctest::Approx(std::sqrt(0.01 / 3) / 1.1));
      CHECK(r.error == r.value);
      CHECK(r.pass);
      c.norm = "max";
      CHECK(evaluate(c, lookup).value.value() == doctest::Approx(0.1 / 1.1));
      // A reference that the run does not reach: what there is gets its number, and the claim
      // fails.
      c.to.reset();
      c.tolerance = 1;
      r = evaluate(c, lookup);
      CHECK(r.value.has_value());
      CHECK_FALSE(r.pass);
      CHECK(r.note.find("1 of 4 points of the reference lie outside of the samples, which reach "
                        "from 0 to 2 s") != std::string::npos);
      c.x_scale = 5;  // the more so when most of it is not reached
      r = evaluate(c, lookup);
      CHECK_FALSE(r.pass);
      CHECK(r.note.find("lie outside") != std::string::npos);
      c.y = "nothing";
      CHECK(evaluate(c, lookup).note.find("no column 'nothing'") != std::string::npos);
      CHECK_FALSE(evaluate(c, lookup).pass);
    }
    SUBCASE("profiles") {
      // Heights of a line that rises with time: z = (1 + t) x / 2 at x = 0, 1, 2 m; one more
      // column.
      Series line("line", {{"height_0", "m", "", 0.0},
                           {"height_1", "m", "", 1.0},
                           {"height_2", "m", "", 2.0},
                           {"slope_angle", "deg", ""}});
      for (const double t : {0.0, 1.0, 2.0})
        line.add(t, std::vector<double>{0, 0.5 * (1 + t), 1 + t, 40});
      const auto find = [&](const std::string& name) { return name == "line" ? &line : nullptr; };
      const test::TemporaryFolder folder;
      write_file_atomically(folder / "ref.csv", "x [mm],z [cm]\n0,0\n500,37.5\n2000,150\n");
      Expect c;
      c.name = "profile";
      c.probe = "line";
      c.reduce = "profile";
      c.reference_csv = FilePath{folder / "ref.csv"};
      c.at = 0.5;  // between two samples
      c.tolerance = 1e-9;
      r = evaluate(c, find);
      CHECK(r.value.value() == doctest::Approx(0));
      CHECK(r.pass);
      c.at.reset();  // the last one, where z = 1.5 x instead of 0.75 x
      c.norm = "max";
      r = evaluate(c, find);
      CHECK(r.value.value() == doctest::Approx(1.0));
      CHECK_FALSE(r.pass);
      c.x_shift = 1;  // the last point of the table lies beyond the line
      c.tolerance = 10;
      r = evaluate(c, find);
      CHECK_FALSE(r.pass);
      CHECK(r.note.find("1 of 3 points of the reference lie outside of the samples, which reach "
                        "from 0 to 2 m") != std::string::npos);
      // Where a height is missing, on either side or in the rows around the time, nothing is
      // claimed.
      Series gap("gap", line.columns());
      for (const double t : {0.0, 1.0, 2.0})
        gap.add(t, std::vector<double>{0, t == 1 ? not_a_number : 0.5 * (1 + t), 1 + t, 40});
      const auto find_gap = [&](const std::string& name) {
        return name == "line" ? &gap : nullptr;
      };
      c.x_shift = 0;
      c.at = 0.5;
      r = evaluate(c, find_gap);
      CHECK_FALSE(r.pass);
      CHECK(r.note.find("1 of 3 points") != std::string::npos);  // that between 0 and 1 m
      Expect one;
      one.name = "one";
      one.probe = "line.height_1";
      one.measure = "above";
      one.reduce = "at";
      one.at = 1.5;
      CHECK(evaluate(one, find_gap).note == "there is no value at t = 1.5 s");
      one.at = 2;
      CHECK(evaluate(one, find_gap).value.value() == 1.5);
      one.reduce = "last";
      one.to = 1.2;
      CHECK(evaluate(one, find_gap).note == "there is no value at t = 1.2 s, the end");
      one.to.reset();
      CHECK(evaluate(one, find_gap).value.value() == 1.5);
      // Round-off at the ends of a line: 0.7 - 0.4 < 0.3.
      Series ends("line", {{"height_0", "m", "", 0.0}, {"height_1", "m", "", 0.7 - 0.4}});
      ends.add(0, std::vector<double>{0, 1});
      write_file_atomically(folder / "ends.csv", "x,z\n0,0\n0.3,1\n");
      c.reference_csv = FilePath{folder / "ends.csv"};
      c.at.reset();
      c.tolerance = 1e-6;
      CHECK(evaluate(c, [&](const std::string&) { return &ends; }).pass);
      c.at = 3;  // after the run
      CHECK(evaluate(c, find).note == "no point of the reference can be compared");
    }
    SUBCASE("units of a reference are those of its headings, unless the deck scales it") {
      const test::TemporaryFolder folder;
      Expect c;
      c.probe = "gauge.left.level";  // m
      c.reduce = "curve";
      c.to = 2;
      c.tolerance = 1e-9;
      c.reference_csv = FilePath{folder / "ref.csv"};
      const auto compared = [&](const std::string& text) {
        write_file_atomically(folder / "ref.csv", text);
        return evaluate(c, lookup);
      };
      const double exact = compared("t,z\n0,0\n1,0.5\n2,1.1\n").value.value();
      CHECK(compared("t [ms];z [cm]\n0;0\n1000;50\n2000;110\n").value.value() ==
            doctest::Approx(exact));
      CHECK(compared("t [s],z [Pa]\n0,0\n1,1\n").note.find("'Pa' is not a length") !=
            std::string::npos);
      CHECK(compared("t [s],z [cmm]\n0,0\n1,1\n").note.find("there is no unit 'cmm'") !=
            std::string::npos);
      CHECK(compared("t [s],z\n,0\n1,\n").note.find("no row has both") != std::string::npos);
      CHECK(compared("t,z\n0,1\n1,1\n")
                .note.find("all values of the curve are 1, and norm: l2 "
                           "divides by their range; say norm: "
                           "relative_l2") != std::string::npos);
      CHECK(compared("t [s],z\n3,0\n4,1\n")
                .note.find("no row lies between 'from' and 'to': the "
                           "curve reaches from t = 3 to 4 s") != std::string::npos);
      c.y_scale = 0.05;
      CHECK(compared("t,z\n0,0\n1,10\n2,22\n").value.value() == doctest::Approx(exact));
      CHECK(compared("t,z [-]\n0,0\n1,10\n2,22\n").value.value() == doctest::Approx(exact));
      // A unit is looked at also where the deck scales.
      CHECK(compared("t,z [cmm]\n0,0\n1,10\n").note.find("there is no unit 'cmm'") !=
            std::string::npos);
      CHECK(compared("t,z [Pa]\n0,0\n1,10\n")
                .note.find("'Pa' is not a length; take it out of the "
                           "heading if y_scale makes it one") != std::string::npos);
      CHECK(compared("t,z [cm]\n0,0\n1,10\n")
                .note.find("by its unit the numbers are multiplied by "
                           "0.01, and the deck says y_scale: 0.05") != std::string::npos);
      c.y_scale = 0.01;  // what the unit says too
      CHECK(compared("t,z [cm]\n0,0\n1,50\n2,110\n").value.value() == doctest::Approx(exact));
      c.y_scale = 1;
      c.scale = 0.01;  // the measured metres become centimetres
      CHECK(compared("t,z [cm]\n0,0\n1,50\n2,110\n").value.value() == doctest::Approx(exact));
      c.x_scale = 0.5;
      CHECK(compared("t [ms],z\n0,0\n").note.find("x_scale: 0.5") != std::string::npos);
    }
    SUBCASE("what cannot be measured fails and says why") {
      Expect b = e;
      b.probe = "other";
      CHECK(evaluate(b, lookup).note == "no probe 'other'");
      b.probe = "gauge.left.q";
      CHECK(evaluate(b, lookup).note == "probe 'gauge.left' has no column 'q'");
      b = e;
      b.reference = 0;
      b.tolerance_kind = "relative";
      CHECK_FALSE(evaluate(b, lookup).pass);
      b.reference.reset();
      CHECK(evaluate(b, lookup).note == "there is no reference to compare with");
      const std::vector<ExpectResult> all = evaluate(std::vector<Expect>{e, b}, lookup);
      const std::string table = render_expectations(all);
      CHECK(table.find("pass") != std::string::npos);
      CHECK(table.find("FAIL") != std::string::npos);
      CHECK(table.find("(there is no reference to compare with)") != std::string::npos);
    }
  }
}
