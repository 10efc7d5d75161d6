#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "report/chart.h"
#include "report/markup.h"

using namespace sphgeo;

namespace {

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size()))
    ++n;
  return n;
}

Chart simple(std::vector<double> x, std::vector<double> y) {
  Chart chart;
  chart.x = {"time", "s", false, {}, {}};
  chart.y = {"pressure", "Pa", false, {}, {}};
  ChartCurve curve;
  curve.x = std::move(x);
  curve.y = std::move(y);
  chart.curves.push_back(curve);
  return chart;
}

}  // namespace

TEST_SUITE("report") {
  TEST_CASE("marks of a linear axis are round numbers inside of it") {
    CHECK(linear_ticks(0, 1, 5) == std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1});
    CHECK(linear_ticks(-3, 17, 4) == std::vector<double>{0, 5, 10, 15});
    CHECK(linear_ticks(1, 1).empty());
    CHECK(linear_ticks(0, std::numeric_limits<double>::infinity()).empty());
    for (const double scale : {1e-300, 1e-9, 3.7, 1e12, 1e300}) {
      const auto ticks = linear_ticks(-0.3 * scale, 1.7 * scale);
      CHECK(ticks.size() >= 3);
      CHECK(ticks.size() <= 7);
      CHECK(ticks.front() >= -0.3 * scale);
      CHECK(ticks.back() <= 1.7 * scale * (1 + 1e-12));
    }
    CHECK(linear_ticks(1e16, 1e16 + 4).size() <= 7);
  }

  TEST_CASE("marks of a logarithmic axis are powers of ten, with 2 and 5 on short ones") {
    CHECK(log_ticks(0.5, 2000) == std::vector<double>{1, 10, 100, 1000});
    CHECK(log_ticks(0.9, 11) == std::vector<double>{1, 2, 5, 10});
    CHECK(log_ticks(1e-30, 1e30).size() <= 8);
    CHECK(log_ticks(30, 32).size() >= 2);
    CHECK(log_ticks(0, 10).empty());
  }

  TEST_CASE("the power of ten of large numbers goes into the title") {
    const AxisScale axis({"pressure", "Pa", false, {}, {}}, 0, 48000, 5);
    CHECK(axis.title() == "pressure (10³\u00a0Pa)");
    CHECK(axis.text(20000) == "20");
    const AxisScale small({"", "m", false, {}, {}}, -0.0004, 0.0004, 5);
    CHECK(small.title() == "10⁻⁶\u00a0m");
    CHECK(small.text(-0.0002) == "−200");
    const AxisScale plain({"share", "1", false, {}, {}}, 0, 1, 5);
    CHECK(plain.title() == "share");
    CHECK(plain.position(0.52) == doctest::Approx(0.5));
  }

  TEST_CASE("a logarithmic axis shows no zero and no negative value") {
    const AxisScale axis({"error", "", true, {}, {}}, 1e-3, 1, 5);
    CHECK(std::isnan(axis.position(0)));
    CHECK(std::isnan(axis.position(-1)));
    CHECK(axis.position(1e-3) > 0);
    CHECK(axis.position(1) < 1);
    CHECK(axis.text(0.01) == "0.01");
    CHECK(axis.text(1e-5) == "10⁻⁵");
    Chart chart = simple({1, 10, 100, 1000}, {0.1, 0, 0.2, 0.3});
    chart.x.log = chart.y.log = true;
    CHECK(count(chart_svg(chart), "NaN") == 0);
    CHECK(count(chart_svg(chart), "nan") == 0);
  }

  TEST_CASE("values that are not finite are gaps") {
    const double nan = std::nan("");
    const std::string svg = chart_svg(simple({0, 1, 2, 3, 4}, {1, 2, nan, 3, 4}));
    const auto start = svg.find("<path d=\"", svg.find("<svg x="));
    const std::string path = svg.substr(start, svg.find("/>", start) - start);
    CHECK(count(path, "M") == 2);
    CHECK(count(path, "L") == 2);
    CHECK(count(svg, "nan") == 0);
    CHECK(chart_svg(simple({0, 1}, {nan, nan})).find("no values") != std::string::npos);
    CHECK(chart_svg(simple({}, {})).find("no values") != std::string::npos);
    CHECK(chart_svg(simple({1}, {5})).find("no values") == std::string::npos);
    CHECK_THROWS_AS(chart_svg(simple({1, 2}, {5})), std::invalid_argument);
  }

  TEST_CASE("all texts are escaped") {
    Chart chart = simple({0, 1}, {0, 1});
    chart.title = "<script>alert(1)</script>";
    chart.x.title = "a & b";
    chart.curves[0].name = "\"quoted\" </svg>";
    chart.curves[0].labels = {"<b>", ""};
    const std::string svg = chart_svg(chart);
    CHECK(svg.find("<script") == std::string::npos);
    CHECK(svg.find("a &amp; b") != std::string::npos);
    CHECK(count(svg, "</svg>") == 2);
    CHECK(svg.find("<b>") == std::string::npos);
  }

  TEST_CASE("long curves are thinned, and keep their peaks") {
    std::vector<double> x, y;
    for (int i = 0; i < 200000; ++i) {
      x.push_back(i);
      y.push_back(i == 123456 ? 1.0 : 0.0);
    }
    Chart chart = simple(x, y);
    const std::string svg = chart_svg(chart);
    CHECK(svg.size() < 60000);
    chart.curves[0].y[123456] = 0;
    CHECK(chart_svg(chart) != svg);
  }

  TEST_CASE("numbers to read") {
    CHECK(number_text(0) == "0");
    CHECK(number_text(1234.5678) == "1235");
    CHECK(number_text(-0.012345678) == "−0.01235");
    CHECK(number_text(123456) == "123456");
    CHECK(number_text(1.2e-5) == "1.2×10⁻⁵");
    CHECK(number_text(1e9) == "10⁹");
    CHECK(number_text(std::nan("")) == "–");
    CHECK(count_text(1234567) == "1\u202f234\u202f567");
    CHECK(count_text(-12) == "−12");
    CHECK(unit_text("kg/m3") == "kg/m³");
    CHECK(unit_text("kg m/s") == "kg m/s");
    CHECK(unit_text("1").empty());
  }

  TEST_CASE("base64 and scripts") {
    CHECK(base64("") == "");
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foo") == "Zm9v");
    CHECK(base64("foobar") == "Zm9vYmFy");
    CHECK(script_escaped("{\"a\":\"</script><!--\"}") == "{\"a\":\"\\u003c/script>\\u003c!--\"}");
  }
}
