#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <vector>

#include "core/atomic_file.h"
#include "core/csv_table.h"
#include "output/csv.h"
#include "output/series.h"
#include "temporary_folder.h"

using namespace sphgeo;

namespace {

const double none = std::numeric_limits<double>::quiet_NaN();
const std::vector<Column> columns = {
    {"time", "s", "simulated time"}, {"p", "Pa", "pressure, mean"}, {"ratio", "1", ""}};
using Row = std::vector<double>;

}  // namespace

TEST_SUITE("output") {
  TEST_CASE("a CSV file: legend, headings, shortest numbers, empty cells") {
    const test::TemporaryFolder folder;
    {
      CsvWriter csv(folder / "a.csv", "two\nlines", columns);
      csv.row(Row{0, none, -1});
      csv.row(Row{0.1, 1.0 / 3, std::numeric_limits<double>::infinity()});
      CHECK_THROWS_AS(csv.row(Row{1}), std::invalid_argument);
    }
    CHECK(read_file(folder / "a.csv") ==
          "# sphgeo: two lines\n# time [s]: simulated time\n# p [Pa]: pressure, mean\n# ratio: \n"
          "time [s],p [Pa],ratio\n0,,-1\n0.1,0.3333333333333333,\n");
    const CsvTable back = read_csv_table(folder / "a.csv");
    CHECK(back.numbers("p")[1] == 1.0 / 3);  // the same bits
    CHECK(std::isnan(back.numbers("p")[0]));
  }

  TEST_CASE("a heading with a comma is quoted") {
    CHECK(csv_head("t", {{"a,\"b\"", "", "s"}}) == "# sphgeo: t\n# a,\"b\": s\n\"a,\"\"b\"\"\"\n");
  }

  TEST_CASE("rows are held back, and written at once when asked") {
    const test::TemporaryFolder folder;
    CsvWriter lazy(folder / "lazy.csv", "t", columns, 1e9);
    const std::size_t head = read_file(folder / "lazy.csv").size();
    lazy.row(Row{0, 1, 2});
    CHECK(read_file(folder / "lazy.csv").size() == head);
    lazy.flush(true);
    CHECK(read_file(folder / "lazy.csv").size() == head + 6);
    CHECK(lazy.offset() == head + 6);
    for (int i = 0; i < 20000; ++i) lazy.row(Row{1, 2, 3});
    CHECK(read_file(folder / "lazy.csv").size() > head + 6 + 60000);  // memory stays bounded

    CsvWriter eager(folder / "eager.csv", "t", columns, 0);
    eager.row(Row{0, 1, 2});
    CHECK(read_file(folder / "eager.csv").size() == head + 6);
  }

  TEST_CASE("a resumed file equals one that was never interrupted") {
    const test::TemporaryFolder folder;
    std::uint64_t offset = 0;
    {
      CsvWriter csv(folder / "a.csv", "t", columns);
      csv.row(Row{0, 1, 2});
      csv.flush();
      offset = csv.offset();
      csv.row(Row{9, 9, 9});  // after the checkpoint: lost
    }
    {
      CsvWriter csv = CsvWriter::resume(folder / "a.csv", "t", columns, offset);
      csv.row(Row{1, 2, 3});
    }
    CsvWriter whole(folder / "b.csv", "t", columns);
    whole.row(Row{0, 1, 2});
    whole.row(Row{1, 2, 3});
    whole.flush();
    CHECK(read_file(folder / "a.csv") == read_file(folder / "b.csv"));

    CHECK_THROWS_AS(CsvWriter::resume(folder / "a.csv", "t", columns, 100000), IoError);
    CHECK_THROWS_AS(CsvWriter::resume(folder / "a.csv", "t", columns, offset + 1), IoError);
    CHECK_THROWS_AS(CsvWriter::resume(folder / "a.csv", "u", columns, offset), IoError);
    CHECK_THROWS_AS(CsvWriter::resume(folder / "none.csv", "t", columns, 10), IoError);
    CHECK(read_file(folder / "a.csv") == read_file(folder / "b.csv"));  // refusals change nothing
  }

  TEST_CASE("a full disk and a missing folder are input-output failures") {
    CHECK_THROWS_WITH_AS(CsvWriter("/nowhere/a.csv", "t", columns),
                         "/nowhere/a.csv: cannot create the file: No such file or directory",
                         IoError);
    CHECK_THROWS_AS(CsvWriter("/dev/full", "t", columns), IoError);
  }

  TEST_CASE("a file that is removed while it grows is said to be lost") {
    const test::TemporaryFolder folder;
    CsvWriter csv(folder / "a.csv", "t", columns);
    csv.row(Row{0, 1, 2});
    csv.flush(true);
    std::filesystem::remove(folder / "a.csv");
    csv.row(Row{1, 2, 3});
    CHECK_THROWS_WITH_AS(csv.flush(true), doctest::Contains("was removed while"), IoError);
    for (const char* text : {"", "a line\n"}) {
      CsvWriter other(folder / "b.csv", "t", columns);
      other.flush(true);
      std::filesystem::resize_file(folder / "b.csv", std::strlen(text));
      other.row(Row{1, 2, 3});
      CHECK_THROWS_WITH_AS(other.flush(true), doctest::Contains("was changed by"), IoError);
    }
  }

  TEST_CASE("a series keeps and writes its samples") {
    const test::TemporaryFolder folder;
    Series series("gauge", {{"p", "Pa", "pressure"}, {"level", "m", "water level"}});
    series.write_to(folder / "gauge.csv", 0);
    series.add(0, Row{1, none});
    series.add(0.5, std::vector<std::optional<double>>{std::nullopt, 2.0});
    CHECK(series.times().size() == 2);
    CHECK(std::isnan(series.column("p")[1]));
    CHECK(series.column("level")[1] == 2);
    CHECK(series.has("p"));
    CHECK_FALSE(series.has("time"));
    CHECK_THROWS_AS(series.column("q"), std::out_of_range);
    CHECK_THROWS_AS(series.add(0.4, Row{1, 2}), std::invalid_argument);
    CHECK_THROWS_AS(series.add(none, Row{1, 2}), std::invalid_argument);
    CHECK_THROWS_AS(series.add(1, Row{1}), std::invalid_argument);
    const std::uint64_t offset = series.flush();
    series.add(1, Row{7, 7});

    Series again("gauge", series.columns());
    again.resume(folder / "gauge.csv", offset, 0);
    REQUIRE(again.times().size() == 2);
    CHECK(again.column("p")[0] == 1);
    CHECK(std::isnan(again.column("level")[0]));
    again.add(1, Row{7, 7});
    CHECK(read_csv_table(folder / "gauge.csv").numbers("p").size() == 3);
    CHECK(read_csv_table(folder / "gauge.csv").numbers("level")[2] == 7);

    for (const char* damage : {"0.2,1,2\n", ",1,2\n", "a,1,2\n", "2,1\n"}) {
      const std::string text = read_file(folder / "gauge.csv") + damage;
      write_file_atomically(folder / "damaged.csv", text);
      Series damaged("gauge", series.columns());
      CHECK_THROWS_AS(damaged.resume(folder / "damaged.csv", text.size(), 0), IoError);
    }
  }
}
