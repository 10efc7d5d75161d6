// CSV tables, and the results that a resumed run continues.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <span>

#include "core/csv_table.h"
#include "core/error.h"
#include "output/csv.h"
#include "output/pvd.h"
#include "output/series.h"
#include "targets.h"

namespace sphgeo::fuzz {

namespace {

void write(const std::string& path, std::string_view text) {
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(text.data(), static_cast<std::streamsize>(text.size()));
}

void resume_pvd(std::string_view text) {
  const std::string path = scratch_folder() + "/set.pvd";
  write(path, text);
  try {
    PvdFile pvd = PvdFile::resume(path, 1.0);
    for (const PvdFile::Frame& f : pvd.frames()) require(f.time <= 1.0, "later frames are dropped");
    pvd.add(2.0, "set_000009.vtu");
    const std::size_t frames = pvd.frames().size();
    require(PvdFile::resume(path, 2.0).frames().size() == frames, "a collection reads back");
  } catch (const IoError&) {
  }
}

void resume_csv(std::string_view rest) {
  const std::string path = scratch_folder() + "/probe.csv";
  const std::vector<Column> columns = {{"p", "Pa", "pressure"}, {"v", "m/s", "speed"}};
  std::vector<Column> all = {{"time", "s", "simulated time of the sample"}};
  all.insert(all.end(), columns.begin(), columns.end());
  const std::string text = csv_head("probe", all) + std::string(rest);
  for (const std::size_t offset : {text.rfind('\n') + 1, text.size(), text.size() + 1}) {
    write(path, text);
    try {
      Series series("probe", columns);
      series.resume(path, offset, 0);
      const std::size_t rows = series.times().size();
      series.add(rows == 0 ? 0.0 : series.times().back(), std::vector<double>{1.0, std::nan("")});
      require(read_csv_table(path).rows() == rows + 1, "a continued table has one row more");
    } catch (const IoError&) {
    } catch (const TableError&) {
    }
  }
}

}  // namespace

void run_csv(std::string_view input) {
  try {
    const CsvTable table = parse_csv_table(input, "t.csv");
    require(!table.names().empty(), "a table has columns");
    // Each look at a column costs as much as there are columns: a line of commas would take
    // seconds.
    for (const std::string& name :
         std::span(table.names()).first(std::min<std::size_t>(table.names().size(), 50))) {
      require(table.has(name) && table.text(name).size() == table.rows(),
              "columns are equally long");
      try {
        for (const double v : table.numbers(name)) require(!std::isinf(v), "no cell is infinite");
      } catch (const TableError&) {
      }
      if (table.rows() > 0)
        require(table.where(name, table.text(name).front()).rows() > 0,
                "a row is found by its cell");
    }
  } catch (const TableError&) {
  }
}

/// The first byte chooses the reader, the rest is the file.
void run_resume(std::string_view input) {
  if (input.empty()) return;
  if (input.front() == 'c') resume_csv(input.substr(1));
  else resume_pvd(input.substr(1));
}

}  // namespace sphgeo::fuzz
