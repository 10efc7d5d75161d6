#include <doctest/doctest.h>

#include <cmath>
#include <thread>

#include "deck/expression.h"

using namespace sphgeo;

namespace {

const Variables variables{{{"L", 2.0}, {"depth", 0.5}, {"failed", std::nan("")}}};

double value_of(const char* formula) {
  return Expression::parse(formula, variables)(Vec3(2, 3, 4), 5);
}

/// The error's offset, or -1 when the formula is fine.
int error_at(const char* formula, const std::string& allowed = "xyzt") {
  try {
    Expression::parse(formula, variables, allowed);
    return -1;
  } catch (const FormulaError& e) {
    return e.offset;
  }
}

std::string help_for(const char* formula) {
  try {
    Expression::parse(formula, variables);
    return "no error";
  } catch (const FormulaError& e) {
    return e.help;
  }
}

}  // namespace

TEST_SUITE("deck") {
  TEST_CASE("formulas use space, time, variables and functions") {
    CHECK(value_of("x + 10*y + 100*z + 1000*t") == 5432.0);
    CHECK(value_of("2*L + depth") == 4.5);
    CHECK(value_of("min(3, 1, 2) + max(x, y)") == 4.0);
    CHECK(value_of("sin(pi/2)") == doctest::Approx(1.0));
    CHECK(value_of("atan2(1, 1)") == doctest::Approx(std::atan(1.0)));
    CHECK(value_of("ln(exp(2)) + log(exp(1))") == doctest::Approx(3.0));
    CHECK(value_of("pow(x, 3) + x^3") == 16.0);
    CHECK(value_of("-x^2") == -4.0);
    CHECK(value_of("x > 1 ? 7 : 8") == 7.0);
    CHECK(value_of("x > 2 ? 7 : 8") == 8.0);
    CHECK(value_of("step(x - 2) + step(x - 3)") == 1.0);
    CHECK(value_of("ramp(x - 1) + ramp(x - 5)") == 1.0);
    CHECK(value_of("clamp(x, 0, 1.5)") == 1.5);
    CHECK(value_of("smoothstep(0, 4, x)") == 0.5);
    CHECK(value_of("tanh(0) + sinh(0) + cosh(0) + abs(-1) + sqrt(4)") == 4.0);
    CHECK(value_of("1e3 + 2.5e-1") == 1000.25);
  }

  TEST_CASE("a formula knows what it depends on") {
    CHECK(Expression::parse("2*L", variables).is_constant());
    CHECK(Expression::parse("2*L", variables).text() == "4");
    CHECK(Expression::parse("t", variables).depends_on_time());
    CHECK_FALSE(Expression::parse("x", variables).depends_on_time());
    CHECK(Expression::parse("x", variables).depends_on_space());
    CHECK(Expression::parse("x*L", variables).text() == "x*L");
    CHECK(Expression(0.1).text() == "0.1");
    CHECK(Expression()(Vec3::Zero(), 0) == 0.0);
  }

  TEST_CASE("malformed formulas are refused where they go wrong") {
    CHECK(error_at("") == 0);
    CHECK(error_at("(1, 2)") == 2);
    CHECK(error_at("1, 2") == 1);
    CHECK(error_at("x = 3") == 2);
    CHECK(error_at("2L") == 1);
    CHECK(error_at("1 + dept") == 4);
    CHECK(error_at("010*2") == 0);
    CHECK(error_at("1 + 0x10") >= 4);
    CHECK(error_at("(1") >= 0);
    CHECK(error_at("1)") == 1);
    CHECK(error_at("x $ 2") == 2);
    CHECK(error_at("\"a\"") == 0);
    // A value too near to zero could not be written out as a number that is read back.
    CHECK(error_at("1e-300*1e-8") == 0);
    CHECK(error_at("1e-300*1e-7") == -1);
    CHECK(value_of("1e-300*1e-300") == 0.0);
    CHECK(error_at("x*1e-300*1e-8") == -1);  // not a constant
    for (const char* bad : {"sqrt(-1)", "1/0", "sqrt(1, 2)", "min()", "1 +", "*2", "x y", "L(2)",
                            "sin", "()", "1:2", "1e999", "_pi", "rnd()"}) {
      CAPTURE(bad);
      CHECK(error_at(bad) >= 0);
    }
    CHECK(error_at(std::string(3000, '1').c_str()) == 0);
    CHECK(error_at(std::string(500, '(').c_str()) >= 0);
  }

  TEST_CASE("unknown names get the nearest one") {
    CHECK(help_for("dept*2") == "did you mean 'depth'?");
    CHECK(help_for("sqt(2)") == "did you mean 'sqrt'?");
  }

  TEST_CASE("only the names allowed for a key are known") {
    CHECK(error_at("t", "xyz") == 0);
    CHECK(error_at("x", "t") == 0);
    CHECK(error_at("t", "t") == -1);
    CHECK_THROWS_AS(evaluate_constant("x", variables), FormulaError);
    CHECK(evaluate_constant("L/4", variables) == 0.5);
  }

  TEST_CASE("a failed variable is named, so that nobody reports it twice") {
    try {
      evaluate_constant("2*failed", variables);
      FAIL("no error");
    } catch (const FormulaError& e) {
      CHECK(e.unknown_name == "failed");
    }
  }

  TEST_CASE("several threads evaluate one formula at once") {
    const Expression e = Expression::parse("x*x + sin(y)*t", {});
    std::vector<int> wrong(8, 0);
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < wrong.size(); ++k) {
      threads.emplace_back([&, k] {
        for (int i = 0; i < 2000; ++i) {
          const double x = static_cast<double>(k) + i;
          wrong[k] += e(Vec3(x, 0, 0), x) != x * x;
        }
      });
    }
    for (std::thread& t : threads) t.join();
    for (const int w : wrong) CHECK(w == 0);
  }

  TEST_CASE("variables may not take names that mean something else") {
    CHECK(why_no_variable("depth_2").empty());
    for (const char* bad : {"", "2a", "a-b", "x", "t", "pi", "sin", "a b"}) {
      CAPTURE(bad);
      CHECK_FALSE(why_no_variable(bad).empty());
    }
  }
}
