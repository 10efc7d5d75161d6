#include "geometry/terrain_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "core/atomic_file.h"
#include "core/csv_table.h"
#include "core/text.h"
#include "core/words.h"
#include "deck/table_columns.h"
#include "geometry/grid_axis.h"

namespace sphgeo {
namespace {

constexpr double hole = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t max_file_bytes = std::uint64_t{512} << 20;
constexpr double most_heights = 2e7;

// What programs write where they know no height.
constexpr double usual_no_data[] = {-9999, -32768, -3.4028234663852886e38, 3.4028234663852886e38};

void mark_holes(std::vector<double>& heights, std::optional<double> no_data) {
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-6 * std::abs(b); };
  for (double& z : heights) {
    const bool marked = no_data ? near(z, *no_data)
                                : std::any_of(std::begin(usual_no_data), std::end(usual_no_data),
                                              [&](double mark) { return near(z, mark); });
    if (marked) z = hole;
  }
}

void skip_comments(Words& words) {
  while (words.peek().starts_with('#')) {
    words.next();
    words.skip_line();
  }
}

bool is_header_word(const std::string& word) {
  for (const char* known : {"ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter",
                            "cellsize", "dx", "dy", "nodata_value"})
    if (word == known) return true;
  return false;
}

TerrainGrid read_esri(std::string_view text, const std::string& path,
                      std::optional<double> no_data) {
  Words words(text, path);
  std::map<std::string, double> header;
  for (;;) {
    skip_comments(words);
    const std::string word = lower_case(words.peek());
    if (!is_header_word(word)) break;
    words.next();
    if (header.contains(word)) words.fail("'" + word + "' is given twice");
    header[word] = words.number();
    if (word != "nodata_value" && !std::isfinite(header[word]))
      words.fail("'" + word + "' is not a finite number");
  }
  for (const auto& [one, other] :
       {std::pair{"xllcorner", "xllcenter"}, std::pair{"yllcorner", "yllcenter"},
        std::pair{"cellsize", "dx"}, std::pair{"cellsize", "dy"}})
    if (header.contains(one) && header.contains(other))
      words.fail(fmt::format("'{}' and '{}' are both given: leave one of them out", one, other));
  const auto value = [&](const char* name) {
    const auto found = header.find(name);
    if (found == header.end()) words.fail(fmt::format("the header has no '{}'", name));
    return found->second;
  };
  const auto count = [&](const char* name) {
    const double n = value(name);
    if (!(n >= 1 && n <= most_heights && n == std::floor(n)))
      words.fail(fmt::format("'{}' is {}, not a number of heights", name, exact(n)));
    return static_cast<int>(n);
  };
  std::optional<double> marked;
  TerrainGrid grid;
  grid.placed = true;
  grid.nx = count("ncols");
  grid.ny = count("nrows");
  if (double{1} * grid.nx * grid.ny > most_heights)
    words.fail(fmt::format("{} x {} heights are too many: use a coarser grid", grid.nx, grid.ny));
  grid.dx = header.contains("dx") ? value("dx") : value("cellsize");
  grid.dy = header.contains("dy") ? value("dy") : value("cellsize");
  if (!(grid.dx > 0 && grid.dy > 0)) words.fail("the size of a cell must be positive");
  // A corner is that of a cell, whose height stands at its centre.
  grid.x = header.contains("xllcenter") ? value("xllcenter") : value("xllcorner") + 0.5 * grid.dx;
  grid.y = header.contains("yllcenter") ? value("yllcenter") : value("yllcorner") + 0.5 * grid.dy;
  // What the header says, and also the usual marks: nothing real is that deep.
  if (!no_data && header.contains("nodata_value")) marked = header["nodata_value"];
  grid.heights.resize(static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny));
  for (int row = grid.ny - 1; row >= 0; --row)
    for (int i = 0; i < grid.nx; ++i) {
      const double z = words.number();
      if (std::isinf(z)) words.fail("a height is infinite");
      grid.heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.nx) +
                   static_cast<std::size_t>(i)] = z;
    }
  if (const auto rest = words.next(); !rest.empty())
    words.fail(fmt::format("'{}' after the last of {} x {} heights", shortened(rest, 40), grid.nx,
                           grid.ny));
  if (marked) mark_holes(grid.heights, marked);
  mark_holes(grid.heights, no_data);
  return grid;
}

TerrainGrid read_points(const CsvTable& table, std::optional<double> no_data) {
  check_columns(table, {"x", "y", "z"});
  const std::vector<double> x = si_column(table, "x", unit::length),
                            y = si_column(table, "y", unit::length);
  std::vector<double> z = table.numbers("z");
  mark_holes(z, no_data);
  z = in_si(table, "z", std::move(z), column_unit(table, "z", unit::length));
  if (x.empty()) throw TableError(table.path() + ": the table has no points");
  const GridAxis along(table, "x", x), across(table, "y", y);
  TerrainGrid grid;
  grid.nx = along.count;
  grid.ny = across.count;
  grid.placed = true;
  grid.x = along.first;
  grid.y = across.first;
  grid.dx = along.step;
  grid.dy = across.step;
  grid.slack = std::max(along.slack, across.slack);
  if (double{1} * grid.nx * grid.ny > 8.0 * static_cast<double>(x.size()) + 64)
    throw TableError(
        fmt::format("{}: the points lie on no grid: {} points, and the closest of "
                    "them make one of {} x {}",
                    table.path(), x.size(), grid.nx, grid.ny));
  const std::size_t nodes = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
  grid.heights.assign(nodes, hole);
  std::vector<std::size_t> row_of(nodes, table.rows());
  for (std::size_t row = 0; row < x.size(); ++row) {
    const std::size_t node =
        static_cast<std::size_t>(across.node(y[row], row)) * static_cast<std::size_t>(grid.nx) +
        static_cast<std::size_t>(along.node(x[row], row));
    if (row_of[node] < table.rows())
      throw TableError(
          fmt::format("{}: the same point as {}", table.place(row), table.place(row_of[node])));
    row_of[node] = row;
    grid.heights[node] = z[row];
  }
  return grid;
}

TerrainGrid read_grid(const CsvTable& table, std::optional<double> no_data) {
  TerrainGrid grid;
  grid.nx = static_cast<int>(table.names().size());
  grid.ny = static_cast<int>(table.rows());
  const auto nx = table.names().size();
  grid.heights.assign(nx * table.rows(), 0.0);
  for (std::size_t i = 0; i < nx; ++i) {
    const std::vector<double> column = table.numbers(table.names()[i]);
    for (std::size_t j = 0; j < column.size(); ++j) grid.heights[j * nx + i] = column[j];
  }
  mark_holes(grid.heights, no_data);
  return grid;
}

// Whether three columns without names look like points: rows that repeat few x and few y.
bool may_be_points(const CsvTable& table) {
  if (table.names().size() != 3 || table.rows() < 4) return false;
  const auto distinct = [&](const char* column) {
    std::vector<double> v = table.numbers(column);
    std::sort(v.begin(), v.end());
    return static_cast<std::size_t>(std::unique(v.begin(), v.end()) - v.begin());
  };
  return distinct("1") * distinct("2") == table.rows();
}

bool begins_as_esri(std::string_view text) {
  Words words(text, "");
  skip_comments(words);
  return is_header_word(lower_case(words.peek()));
}

}  // namespace

TerrainGrid read_terrain(const std::string& path, const std::string& format,
                         std::optional<double> no_data) {
  std::string text = read_file(path, max_file_bytes);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // a byte order mark
  if (format == "esri" || (format == "auto" && begins_as_esri(text)))
    return read_esri(text, path, no_data);
  const CsvTable table = parse_csv_table(text, path, static_cast<std::size_t>(3 * most_heights));
  if (format == "auto") table.check_headings();
  if (format == "points" || (format == "auto" && table.named())) return read_points(table, no_data);
  table.check_headings();
  if (table.named())
    throw TableError(table.header_place() + ": a grid of heights has no column names");
  if (format == "auto" && may_be_points(table))
    throw TableError(path +
                     ": three columns of heights, or x, y, z of points? Begin points with a line "
                     "'x,y,z', or say format: grid");
  return read_grid(table, no_data);
}

Index fill_holes(TerrainGrid& grid) {
  const int nx = grid.nx, ny = grid.ny;
  const auto at = [&](int i, int j) -> double& {
    return grid.heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) +
                        static_cast<std::size_t>(i)];
  };
  const auto mean_around = [&](int i, int j) {
    double sum = 0;
    int n = 0;
    const int around[4][2] = {{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}};
    for (const auto& [k, l] : around)
      if (k >= 0 && k < nx && l >= 0 && l < ny && !std::isnan(at(k, l))) {
        sum += at(k, l);
        ++n;
      }
    return n > 0 ? sum / n : hole;
  };
  std::vector<std::array<int, 2>> holes;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      if (std::isnan(at(i, j))) holes.push_back({i, j});
  if (holes.size() == grid.heights.size()) throw std::logic_error("a terrain without heights");
  // First from the rim inwards, layer by layer; then sweeps to the solution.
  std::vector<std::array<int, 2>> open = holes;
  while (!open.empty()) {
    std::vector<std::pair<std::array<int, 2>, double>> layer;
    std::vector<std::array<int, 2>> inner;
    for (const auto& h : open)
      if (const double z = mean_around(h[0], h[1]); std::isnan(z)) inner.push_back(h);
      else layer.push_back({h, z});
    for (const auto& [h, z] : layer) at(h[0], h[1]) = z;
    open = std::move(inner);
  }
  const auto [low, high] = std::minmax_element(grid.heights.begin(), grid.heights.end());
  const double enough = 1e-9 * (*high - *low);
  constexpr double over_relaxation = 1.8;
  for (int sweep = 0; sweep < 5000; ++sweep) {
    double change = 0;
    for (const auto& [i, j] : holes) {
      const double step = over_relaxation * (mean_around(i, j) - at(i, j));
      at(i, j) += step;
      change = std::max(change, std::abs(step));
    }
    if (change <= enough) break;
  }
  return static_cast<Index>(holes.size());
}

}  // namespace sphgeo
