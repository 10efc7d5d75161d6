#include <doctest/doctest.h>

#include <numbers>
#include <stdexcept>

#include "deck/unit.h"

using namespace sphgeo;

namespace {
NumberText::Status status_of(const char* text) { return parse_number(text).status; }
}  // namespace

TEST_SUITE("deck") {
  TEST_CASE("quantities become SI") {
    CHECK(parse_quantity("18 kPa", unit::pressure) == 18000.0);
    CHECK(parse_quantity("30 deg", unit::angle) == doctest::Approx(std::numbers::pi / 6));
    CHECK(parse_quantity("9.81 m/s2", unit::acceleration) == 9.81);
    CHECK(parse_quantity("9.81 m/s^2", unit::acceleration) == 9.81);
    CHECK(parse_quantity("1e-3 Pa s", unit::viscosity) == 1e-3);
    CHECK(parse_quantity("1 mPa*s", unit::viscosity) == 1e-3);
    CHECK(parse_quantity("2 cm", unit::length) == 0.02);
    CHECK(parse_quantity("35 mm", unit::length) == 0.035);
    CHECK(parse_quantity("36 km/h", unit::speed) == 10.0);
    CHECK(parse_quantity("1 g/cm3", unit::density) == 1000.0);
    CHECK(parse_quantity("2.65 t/m3", unit::density) == 2650.0);
    CHECK(parse_quantity("5 %", unit::none) == 0.05);
    CHECK(parse_quantity("5%", unit::none) == 0.05);
    CHECK(parse_quantity("4 1/s", unit::rate) == 4.0);
    CHECK(parse_quantity("4 Hz", unit::rate) == 4.0);
    CHECK(parse_quantity("2 min", unit::time) == 120.0);
    CHECK(parse_quantity("3 kN/m", unit::stiffness) == 3000.0);
    CHECK(parse_quantity("1 N m", unit::energy) == 1.0);
    CHECK(parse_quantity("7", unit::pressure) == 7.0);
  }

  TEST_CASE("another dimension or an unknown unit is refused") {
    CHECK_THROWS_AS(parse_quantity("2 m", unit::time), std::invalid_argument);
    CHECK_THROWS_AS(parse_quantity("2 rad", unit::none), std::invalid_argument);
    CHECK_THROWS_AS(parse_quantity("2 Hz", unit::angular_speed), std::invalid_argument);
    CHECK_THROWS_AS(parse_quantity("2 %", unit::length), std::invalid_argument);
    CHECK_THROWS_AS(parse_quantity("2 furlong", unit::length), std::invalid_argument);
    CHECK_THROWS_AS(parse_quantity("1e308 km", unit::length), std::invalid_argument);
    CHECK(nearest_unit("kPaa") == "kPa");
    for (const char* bad : {"", "m/", "m^", "m//s", "m s/", "mm2x", "m99999", "m9 m9"}) {
      CAPTURE(bad);
      CHECK_FALSE(parse_unit(bad).has_value());
    }
  }

  TEST_CASE("numbers that readers disagree about, or that are not finite, are refused") {
    using Status = NumberText::Status;
    for (const char* good : {"0", "-0", "8", "0.5", ".5", "5.", "+3", "1e3", "1E-3", "-2.5e+2"}) {
      CAPTURE(good);
      CHECK(status_of(good) == Status::number);
    }
    for (const char* bad : {"010", "-007", "0x1F", "0o17", "0b1", "1_000", "1:30", ".inf", "-.Inf",
                            ".nan", "inf", "nan", "1e400", "1e-400", "1e-310"}) {
      CAPTURE(bad);
      CHECK(status_of(bad) == Status::refused);
    }
    for (const char* text : {"", "abc", "1 m", "1.2.3", "--1", "e5", "2*L", "1e"}) {
      CAPTURE(text);
      CHECK(status_of(text) == Status::not_a_number);
    }
    CHECK(parse_number("0e5").value == 0.0);
  }

  TEST_CASE("formulas are not taken for quantities") {
    CHECK(split_quantity("2*L").number.status == NumberText::Status::not_a_number);
    CHECK(split_quantity("1 - 0.5").number.status == NumberText::Status::not_a_number);
    CHECK(split_quantity("1/3").number.status == NumberText::Status::not_a_number);
    CHECK(split_quantity("2 m").unit == "m");
  }
}
