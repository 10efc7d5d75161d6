#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>

#include "core/atomic_file.h"
#include "core/csv_table.h"

using namespace sphgeo;

namespace {

/// The message of the TableError that parsing (and asking for column `p`) throws; "" when none.
std::string failure(const std::string& text, const std::string& column = {}) {
  try {
    const CsvTable table = parse_csv_table(text, "t.csv");
    if (!column.empty()) table.numbers(column);
  } catch (const TableError& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST_SUITE("core") {
  TEST_CASE("a table with comments, units, quotes, empty cells and a foreign line end") {
    const CsvTable t = parse_csv_table(
        "\xEF\xBB\xBF# source: here\r\ntime [s],p [Pa], case \r\n0,1.5e3,\"a, "
        "\"\"b\"\"\"\r\n\r\n0.5,,c\r\n",
        "t.csv");
    CHECK(t.comments() == std::vector<std::string>{"source: here"});
    CHECK(t.names() == std::vector<std::string>{"time [s]", "p [Pa]", "case"});
    CHECK(t.rows() == 2);
    CHECK(t.numbers("time") == std::vector<double>{0, 0.5});
    CHECK(t.numbers("p [Pa]")[0] == 1500);
    CHECK(std::isnan(t.numbers("p")[1]));
    CHECK(t.text("case") == std::vector<std::string>{"a, \"b\"", "c"});
    CHECK(t.has("p"));
    CHECK_FALSE(t.has("q"));
  }

  TEST_CASE("a grid of numbers without names") {
    const CsvTable t = parse_csv_table("# grid\n1,2\n3,4\n", "t.csv");
    CHECK(t.rows() == 2);
    CHECK(t.numbers("2") == std::vector<double>{2, 4});
  }

  TEST_CASE("rows are picked by text or by number") {
    const CsvTable t = parse_csv_table("who,Tv,p\na,0.10,1\nb,0.2,2\na,0.1,3\n", "t.csv");
    CHECK(t.where("who", "a").numbers("p") == std::vector<double>{1, 3});
    CHECK(t.where("Tv", "0.1").numbers("p") == std::vector<double>{1, 3});
    CHECK(t.where("Tv", "9").rows() == 0);
    CHECK_THROWS_AS(t.where("x", "1"), TableError);
  }

  TEST_CASE("every message names file and line") {
    CHECK(failure("a,b\n1,2\n3\n") == "t.csv:3: 1 cells, but there are 2 columns");
    CHECK(failure("a,p\n1,2\n3,4 m\n", "p") == "t.csv:3: column 'p': '4 m' is not a finite number");
    CHECK(failure("a,p\n1,inf\n", "p") == "t.csv:2: column 'p': 'inf' is not a finite number");
    CHECK(failure("a,p\n1,1e999\n", "p") == "t.csv:2: column 'p': '1e999' is not a finite number");
    CHECK(failure("a,p\n1,2\n", "q") == "t.csv: no column 'q' (columns: a, p)");
    CHECK(failure("a,a\n1,2\n") == "t.csv:1: two columns are called 'a'");
    CHECK(failure("a,\n1,2\n") == "t.csv:1: a column has no name");
    CHECK(failure("a,b\n\"1,2\n") == "t.csv:2: the quote is not closed");
    CHECK(failure("a,b\n\"1\"2,3\n") == "t.csv:2: text after a closing quote");
    CHECK(failure("# only words\n") == "t.csv: the table has no row of column names");
    CHECK(failure("a,b\n1,2\n", "b").empty());
  }

  TEST_CASE("a table that would fill the memory is refused") {
    CHECK(parse_csv_table("1,2\n3,4\n", "t.csv", 4).rows() == 2);
    CHECK_THROWS_WITH_AS(parse_csv_table("1,2\n3,4\n5,6\n", "t.csv", 4),
                         "t.csv:3: more than 4 cells", TableError);
    CHECK(failure(fmt::format("{:,>5000}\n", "")).find("more than 4096 columns") !=
          std::string::npos);
  }

  TEST_CASE("cells are separated by commas, semicolons, tabs or blanks") {
    for (const char* text : {"t [s],x [mm]\n0,1.5\n2,3\n", "t [s];x [mm]\n0;1.5\n2;3\n",
                             "t [s]\tx [mm]\n0\t1.5\n2\t3\n", "t [s] x [mm]\n0   1.5\n2 3\n",
                             "t [s]  x [mm]\n  0\t1.5\n 2 3\n", "t [s];x [mm]\r0;1,5\r2;3\r",
                             "t [s]\tx [mm]\n0\t1,5\n2\t3\n", "t [s] x [mm]\n0 1,5\n2,0 3\n"}) {
      CAPTURE(text);
      const CsvTable t = parse_csv_table(text, "t.csv");
      CHECK(t.names() == std::vector<std::string>{"t [s]", "x [mm]"});
      CHECK(t.numbers("t") == std::vector<double>{0, 2});
      CHECK(t.numbers("x") == std::vector<double>{1.5, 3});
      CHECK(t.named());
    }
    CHECK(parse_csv_table("0,5 1,5\n2 3\n", "t.csv").numbers("1") == std::vector<double>{0.5, 2});
    CHECK(parse_csv_table("1, 2\n3, 4\n", "t.csv").numbers("2") == std::vector<double>{2, 4});
    CHECK(parse_csv_table("wave height\n0.5\n", "t.csv").names().size() == 1);
    CHECK(parse_csv_table("wave height,p\n0.5,1\n", "t.csv").names().size() == 2);
    CHECK(parse_csv_table("7, ,5\n8, ,6\n", "t.csv").names().size() == 3);
    CHECK(failure("a,p\n1,+-5\n", "p") == "t.csv:2: column 'p': '+-5' is not a finite number");
    CHECK(failure("x,x [mm]\n1,2\n") == "t.csv:1: two columns are called 'x'");
    CHECK(failure("a;p\n1;1.000,5\n", "p") ==
          "t.csv:2: column 'p': '1.000,5' is not a finite number");
    CHECK(failure("a;p\n1;1,000,000\n", "p") ==
          "t.csv:2: column 'p': '1,000,000' is not a finite number: leave out the commas between "
          "thousands");
  }

  TEST_CASE("separators at the ends of rows make no column, and empty cells at the ends are read") {
    for (const char* text :
         {"t,x,\n0,1,\n2,3,\n", "t;x;;\n0;1;;\n2;3;;\n", "t\tx\t\n0\t1\t\n2\t3\t\n",
          "t,x\n0,1,\n2,3\n", "t,x,\n0,1\n2,3,\n,,\n", "0,1,\n2,3,\n", "0\t1\t\n2\t3\t\n"}) {
      CAPTURE(text);
      const CsvTable t = parse_csv_table(text, "t.csv");
      CHECK(t.names().size() == 2);
      CHECK(t.rows() == 2);
      CHECK(t.numbers(t.names()[1]) == std::vector<double>{1, 3});
    }
    CHECK(failure("t,x,\n0,1,5\n") == "t.csv:1: a column has no name");
    CHECK(failure("t,x\n0,1,5\n") == "t.csv:2: 3 cells, but there are 2 columns");
    // A hole at the end of a row is one where another row has a value there.
    CHECK(std::isnan(parse_csv_table("1,2,\n3,4,5\n", "t.csv").numbers("3")[0]));
    const CsvTable tabs = parse_csv_table("a\tb\tc\n\t2\t3\n4\t5\t\n", "t.csv");
    CHECK(std::isnan(tabs.numbers("a")[0]));
    CHECK(tabs.numbers("b") == std::vector<double>{2, 5});
    CHECK(std::isnan(tabs.numbers("c")[1]));
    CHECK(parse_csv_table("7\t\n8\t\n", "t.csv").names().size() == 1);
  }

  TEST_CASE("numbers that no double holds, and every spelling of nan") {
    CHECK(failure("a,p\n1,1e-400\n", "p") ==
          "t.csv:2: column 'p': '1e-400' is too close to zero for a number: write 0");
    const CsvTable t = parse_csv_table("a,p\n1,-nan\n2,NAN\n3,nan(ind)\n4,5e-324\n", "t.csv");
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::isnan(t.numbers("p")[k]));
    CHECK(t.numbers("p")[3] == 5e-324);
  }

  TEST_CASE("commas between thousands are said") {
    CHECK(failure("a,p\n1,1,234.5\n") ==
          "t.csv:2: 3 cells, but there are 2 columns; if '1,234.5' is one number, leave out the "
          "comma between thousands");
    const std::string said =
        "t.csv:2: column 'p': '1,234.5' is not a finite number: leave out the commas between "
        "thousands";
    CHECK(failure("a,p\n1,\"1,234.5\"\n", "p") == said);
    CHECK(failure("a;p\n1;1,234.5\n", "p") == said);
    CHECK(parse_csv_table("a;p\n1;1,234\n", "t.csv").numbers("p")[0] == 1.234);
  }

  TEST_CASE("a bad number in the first row is said with its column") {
    CHECK(failure("1,x2,1\n4,5,6\n") == "t.csv:1: column 2: 'x2' is not a finite number");
    const auto headings = [](const char* text) { parse_csv_table(text, "t.csv").check_headings(); };
    CHECK_THROWS_WITH(headings("1,2,x3\n4,5,6\n"),
                      "t.csv:1: column 3: 'x3' is not a finite number");
    CHECK_NOTHROW(headings("time,p,1\n4,5,6\n"));
    CHECK_NOTHROW(headings("1,2\n4,5\n"));
  }

  TEST_CASE("comments, lines and encodings of other programs") {
    const CsvTable t = parse_csv_table("% one\n// two\n# three\na,p\n\n1,2\n% four\n3,4", "t.csv");
    CHECK(t.comments() == std::vector<std::string>{"one", "two", "three", "four"});
    CHECK(t.numbers("p") == std::vector<double>{2, 4});
    CHECK(t.header_place() == "t.csv:4");
    CHECK(t.place(1) == "t.csv:8");
    CHECK(parse_csv_table("a,p\r1,2\r\r3,4\r", "t.csv").place(1) == "t.csv:4");
    CHECK(failure(std::string("\xFF\xFE"
                              "a\0",
                              4)) == "t.csv:1: the table is in UTF-16; save it as UTF-8");
  }

  TEST_CASE("a heading has a name and a unit") {
    CHECK(split_heading("p [Pa]").unit == "Pa");
    CHECK(split_heading("p[Pa]").name == "p");
    CHECK(split_heading("angle (deg)").unit == "deg");
    CHECK(split_heading("t sqrt(g)").name == "t sqrt(g)");
    CHECK(split_heading("[Pa]").name == "[Pa]");
    CHECK(split_heading("p Pa]").unit.empty());
  }

  TEST_CASE("where every cell must hold a number, an empty one is an error") {
    const CsvTable t = parse_csv_table("a,p\n1,2\n3,\n4,nan\n", "t.csv");
    CHECK(t.all_numbers("a").size() == 3);
    CHECK_THROWS_WITH_AS(t.all_numbers("p"), "t.csv:3: column 'p': the cell is empty", TableError);
  }

  TEST_CASE("a missing table is an input-output failure") {
    CHECK_THROWS_WITH_AS(read_csv_table("/nowhere/t.csv"),
                         "/nowhere/t.csv: cannot open the file: No such file or directory",
                         IoError);
    CHECK_THROWS_AS(read_csv_table("/"), IoError);
  }
}
