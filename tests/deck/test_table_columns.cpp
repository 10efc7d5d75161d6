#include <doctest/doctest.h>

#include "deck/table_columns.h"

using namespace sphgeo;

namespace {

std::string column_complaint(const std::string& text, const Unit& wanted) {
  try {
    si_column(parse_csv_table(text, "t.csv"), "x", wanted);
  } catch (const TableError& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST_SUITE("deck") {
  TEST_CASE("a column is read in the unit of its heading") {
    const CsvTable t = parse_csv_table("t [ms],x [mm],angle (deg),n [-],y\n35,35,180,2,7\n", "t");
    CHECK(si_column(t, "t", unit::time) == std::vector<double>{0.035});
    CHECK(si_column(t, "x", unit::length) == std::vector<double>{0.035});
    CHECK(si_column(t, "angle", unit::angle)[0] == doctest::Approx(3.141592653589793));
    CHECK(si_column(t, "n", unit::none) == std::vector<double>{2});
    CHECK(si_column(t, "y", unit::length) == std::vector<double>{7});
  }

  TEST_CASE(
      "units that are unknown or of another kind, and empty cells, are refused with the line") {
    CHECK(column_complaint("# a\nt,x [mmm]\n0,1\n", unit::length) ==
          "t.csv:2: column 'x [mmm]': there is no unit 'mmm'; did you mean 'mm'?");
    CHECK(column_complaint("t,x [s]\n0,1\n", unit::length) ==
          "t.csv:1: column 'x [s]': 's' is not a length");
    CHECK(column_complaint("t,x\n0,1\n1,\n", unit::length) ==
          "t.csv:3: column 'x': the cell is empty");
    CHECK(column_complaint("t,x [-]\n0,1\n", unit::length) ==
          "t.csv:1: column 'x [-]': '-' is not a length");
    CHECK(column_complaint("t,x [km]\n0,1\n1,1e308\n", unit::length) ==
          "t.csv:3: column 'x [km]': '1e308' is too large in this unit");
  }

  TEST_CASE("unknown columns are refused with the nearest name") {
    const auto check = [](const char* text) {
      check_columns(parse_csv_table(text, "t.csv"), {"t", "x", "angle"});
    };
    CHECK_NOTHROW(check("t [s],x [mm]\n0,1\n"));
    CHECK_THROWS_WITH(check("t,X\n0,1\n"),
                      "t.csv:1: there is no column 'X' here; did you mean 'x'?");
    CHECK_THROWS_WITH(check("t,roll\n0,1\n"),
                      "t.csv:1: there is no column 'roll' here; columns: t, x and angle");
    CHECK_THROWS_WITH(check("0,1.5o\n1,2\n"), "t.csv:1: column 2: '1.5o' is not a finite number");
    CHECK_THROWS_WITH(check("0,1\n1,2\n"),
                      "t.csv: the table has no row of column names; expected t, x or angle");
  }
}
