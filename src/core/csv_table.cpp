#include "core/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "core/atomic_file.h"

namespace sphgeo {

namespace {

constexpr std::uint64_t max_bytes = std::uint64_t{256} << 20;
constexpr std::size_t max_columns = 4096;

std::string_view trim(std::string_view s) {
  const auto first = s.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

/// A finite number, NaN for "no value", nothing for other text. Independent of the locale.
std::optional<double> to_number(std::string_view s) {
  if (s.empty() || s == "nan" || s == "NaN") return std::numeric_limits<double>::quiet_NaN();
  if (s.front() == '+') s.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (error != std::errc{} || end != s.data() + s.size() || !std::isfinite(value)) return {};
  return value;
}

/// The cells of one line; throws when a quote is not closed or followed by other text.
std::vector<std::string> split(std::string_view line, const std::string& place) {
  std::vector<std::string> cells;
  std::size_t at = 0;
  for (;;) {
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
    if (at < line.size() && line[at] == '"') {
      std::string cell;
      for (++at;; ++at) {
        if (at >= line.size()) throw TableError(place + ": the quote is not closed");
        if (line[at] == '"' && at + 1 < line.size() && line[at + 1] == '"') ++at;
        else if (line[at] == '"') break;
        cell += line[at];
      }
      const std::size_t comma = std::min(line.find(',', ++at), line.size());
      if (!trim(line.substr(at, comma - at)).empty())
        throw TableError(place + ": text after a closing quote");
      cells.push_back(std::move(cell));
      at = comma;
    } else {
      const std::size_t comma = std::min(line.find(',', at), line.size());
      cells.emplace_back(trim(line.substr(at, comma - at)));
      at = comma;
    }
    if (at >= line.size()) return cells;
    ++at;
    if (cells.size() >= max_columns)
      throw TableError(fmt::format("{}: more than {} columns", place, max_columns));
  }
}

/// "p [Pa]" -> "p"
std::string_view without_unit(std::string_view heading) {
  const auto bracket = heading.find(" [");
  return bracket == std::string_view::npos ? heading : heading.substr(0, bracket);
}

}  // namespace

CsvTable parse_csv_table(std::string_view text, const std::string& path, std::size_t max_cells) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a spreadsheet's byte order mark
  CsvTable table;
  table.path_ = path;
  int line_number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trim(text.substr(at, end - at));
    at = end + 1;
    ++line_number;
    if (line.empty()) continue;
    if (line.front() == '#') {
      table.comments_.emplace_back(trim(line.substr(1)));
      continue;
    }
    const std::string place = fmt::format("{}:{}", path, line_number);
    std::vector<std::string> cells = split(line, place);
    if (table.names_.empty()) {
      const bool headless = std::all_of(cells.begin(), cells.end(), [](const std::string& c) {
        return !c.empty() && to_number(c).has_value();
      });
      table.cells_.resize(cells.size());
      if (!headless) {
        std::set<std::string_view> seen;
        for (const std::string& name : cells) {
          if (name.empty()) throw TableError(place + ": a column has no name");
          if (!seen.insert(name).second)
            throw TableError(fmt::format("{}: two columns are called '{}'", place, name));
        }
        table.names_ = std::move(cells);
        continue;
      }
      for (std::size_t i = 1; i <= cells.size(); ++i) table.names_.push_back(std::to_string(i));
    }
    if (cells.size() != table.names_.size())
      throw TableError(fmt::format("{}: {} cells, but there are {} columns", place, cells.size(),
                                   table.names_.size()));
    if ((table.lines_.size() + 1) * cells.size() > max_cells)
      throw TableError(fmt::format("{}: more than {} cells", place, max_cells));
    for (std::size_t c = 0; c < cells.size(); ++c) table.cells_[c].push_back(std::move(cells[c]));
    table.lines_.push_back(line_number);
  }
  if (table.names_.empty()) throw TableError(path + ": the table has no row of column names");
  return table;
}

CsvTable read_csv_table(const std::string& path) {
  return parse_csv_table(read_file(path, max_bytes), path);
}

bool CsvTable::has(std::string_view name) const {
  return std::any_of(names_.begin(), names_.end(),
                     [&](const std::string& n) { return n == name || without_unit(n) == name; });
}

std::size_t CsvTable::index(std::string_view name) const {
  for (std::size_t c = 0; c < names_.size(); ++c)
    if (names_[c] == name) return c;
  for (std::size_t c = 0; c < names_.size(); ++c)
    if (without_unit(names_[c]) == name) return c;
  throw TableError(
      fmt::format("{}: no column '{}' (columns: {})", path_, name, fmt::join(names_, ", ")));
}

const std::vector<std::string>& CsvTable::text(std::string_view name) const {
  return cells_[index(name)];
}

std::vector<double> CsvTable::numbers(std::string_view name) const {
  const std::vector<std::string>& cells = text(name);
  std::vector<double> values;
  values.reserve(cells.size());
  for (std::size_t r = 0; r < cells.size(); ++r) {
    const std::optional<double> value = to_number(cells[r]);
    if (!value)
      throw TableError(fmt::format("{}:{}: column '{}': '{}' is not a finite number", path_,
                                   lines_[r], name, cells[r]));
    values.push_back(*value);
  }
  return values;
}

CsvTable CsvTable::where(std::string_view name, std::string_view value) const {
  const std::vector<std::string>& keys = text(name);
  const std::optional<double> number = to_number(value);
  CsvTable out;
  out.path_ = path_;
  out.comments_ = comments_;
  out.names_ = names_;
  out.cells_.resize(cells_.size());
  for (std::size_t r = 0; r < rows(); ++r) {
    const std::optional<double> key = number ? to_number(keys[r]) : std::nullopt;
    if (keys[r] != value && !(key && *key == *number)) continue;
    for (std::size_t c = 0; c < cells_.size(); ++c) out.cells_[c].push_back(cells_[c][r]);
    out.lines_.push_back(lines_[r]);
  }
  return out;
}

}  // namespace sphgeo
