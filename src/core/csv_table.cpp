#include "core/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "core/atomic_file.h"
#include "core/decimal.h"
#include "core/text.h"

namespace sphgeo {

namespace {

constexpr std::uint64_t max_bytes = std::uint64_t{256} << 20;
constexpr std::size_t max_columns = 4096;

std::string_view trim(std::string_view s) {
  const auto first = s.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

bool is_digit(std::string_view s, std::size_t k) {
  return k < s.size() && s[k] >= '0' && s[k] <= '9';
}

/// A finite number, NaN for "no value", nothing for other text.
std::optional<double> to_number(std::string_view s, bool decimal_comma = false) {
  if (s.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::string with_point;
  if (const auto comma = s.find(','); decimal_comma && comma != std::string_view::npos) {
    if (s.find('.') != std::string_view::npos || comma == 0 || !is_digit(s, comma - 1) ||
        !is_digit(s, comma + 1))
      return {};
    with_point = s;
    with_point[comma] = '.';
    s = with_point;
  }
  const std::optional<double> value = read_decimal(s);
  return value && std::isinf(*value) ? std::nullopt : value;
}

/// Whether the text is a number whose thousands are set off by commas, "1,234.5".
bool has_thousands(std::string_view s) {
  if (s.starts_with('-') || s.starts_with('+')) s.remove_prefix(1);
  auto comma = s.find(',');
  if (comma == 0 || comma > 3) return false;
  for (std::size_t k = 0; k < comma; ++k)
    if (!is_digit(s, k)) return false;
  for (; comma < s.size() && s[comma] == ','; comma += 4)
    for (std::size_t k = comma + 1; k < comma + 4; ++k)
      if (!is_digit(s, k)) return false;
  return comma >= s.size() || s[comma] == '.';
}

/// Why a cell is no number, for the user.
std::string why_no_number(std::string_view cell) {
  if (has_thousands(cell))
    return fmt::format("'{}' is not a finite number: leave out the commas between thousands",
                       shortened(cell, 60));
  std::string why = why_no_decimal(cell);
  if (why.find(" write 0") != std::string::npos) return why;
  return fmt::format("'{}' is not a finite number", shortened(cell, 60));
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Where the cell that begins at `at` ends: at the separator, or at the end of the line.
std::size_t end_of_cell(std::string_view line, std::size_t at, char separator) {
  if (separator != ' ') return std::min(line.find(separator, at), line.size());
  while (at < line.size() && !is_blank(line[at])) ++at;
  return at;
}

/// The cells of one line; throws when a quote is not closed or followed by other text. The
/// separator ' ' stands for any run of blanks and tabs.
std::vector<std::string> split(std::string_view line, char separator, const std::string& place) {
  std::vector<std::string> cells;
  std::size_t at = 0;
  for (;;) {
    while (at < line.size() && is_blank(line[at]) && line[at] != separator) ++at;
    while (separator == ' ' && at < line.size() && is_blank(line[at])) ++at;
    if (at < line.size() && line[at] == '"') {
      std::string cell;
      for (++at;; ++at) {
        if (at >= line.size()) throw TableError(place + ": the quote is not closed");
        if (line[at] == '"' && at + 1 < line.size() && line[at + 1] == '"') ++at;
        else if (line[at] == '"') break;
        cell += line[at];
      }
      const std::size_t end = end_of_cell(line, ++at, separator);
      if (!trim(line.substr(at, end - at)).empty())
        throw TableError(place + ": text after a closing quote");
      cells.push_back(std::move(cell));
      at = end;
    } else {
      const std::size_t end = end_of_cell(line, at, separator);
      cells.emplace_back(trim(line.substr(at, end - at)));
      at = end;
    }
    if (at >= line.size()) return cells;
    ++at;
    if (cells.size() >= max_columns)
      throw TableError(fmt::format("{}: more than {} columns", place, max_columns));
  }
}

/// The headings of a row separated by blanks: "t [s] x [mm]" are two, a unit belongs to its name.
std::vector<std::string> join_units(std::vector<std::string> cells) {
  std::vector<std::string> joined;
  for (std::string& cell : cells) {
    const bool unit = !joined.empty() && (cell.front() == '[' || cell.front() == '(');
    const bool open = !joined.empty() && joined.back().find('[') != std::string::npos &&
                      joined.back().find(']') == std::string::npos;
    if (unit || open) joined.back() += " " + cell;
    else joined.push_back(std::move(cell));
  }
  return joined;
}

/// Whether a row holds numbers only, or numbers and empty cells.
bool all_numbers(const std::vector<std::string>& cells, bool decimal_comma) {
  return std::all_of(
             cells.begin(), cells.end(),
             [&](const std::string& c) { return to_number(c, decimal_comma).has_value(); }) &&
         std::any_of(cells.begin(), cells.end(), [](const std::string& c) { return !c.empty(); });
}

/// Whether the line holds the character outside of quotes.
bool holds(std::string_view line, char wanted) {
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == wanted && !quoted) return true;
  }
  return false;
}

/// What separates the cells, by the first row and the one after it. A comma separates unless all
/// numbers of the row have it as their decimal sign.
char inner_separator(std::string_view first, std::string_view second, const std::string& place) {
  if (holds(first, ';')) return ';';
  for (const char blank : {'\t', ' '}) {
    if (!holds(first, blank)) continue;
    if (!holds(first, ',')) {
      // One heading of several words, or several headings: the numbers below tell.
      if (blank == '\t' || all_numbers(split(first, ' ', place), false)) return blank;
      if (holds(second, ',') && !holds(second, ' ')) return ',';
      if (second.find('"') != std::string_view::npos) return ',';
      const auto below = split(second, ' ', place);
      return below.size() > 1 && all_numbers(below, true) ? ' ' : ',';
    }
    const auto cells = split(first, blank, place);
    if (cells.size() > 1 && all_numbers(cells, true) &&
        !all_numbers(split(first, ',', place), false))
      return blank;
  }
  return ',';
}

/// The same with tabs at the ends of the first row: there they separate where nothing else does.
char separator_of(std::string_view first, std::string_view second, const std::string& place) {
  const char inner = inner_separator(trim(first), trim(second), place);
  return inner == ',' && !holds(first, ',') && holds(first, '\t') ? '\t' : inner;
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

/// The lines of a text with their numbers, without empty ones.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// The next line that is not blank; false at the end of the text.
  bool next(std::string_view& line) {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
      line = text_.substr(at_, end - at_);
      at_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
      ++number_;
      if (!trim(line).empty()) return true;
    }
    return false;
  }
  int number() const { return number_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int number_ = 0;
};

/// A first row that is mostly numbers is a row of numbers, of which one cannot be read.
void refuse_bad_number(const std::vector<std::string>& cells, bool decimal_comma,
                       const std::string& place) {
  const auto is_number = [&](const std::string& c) {
    return !c.empty() && to_number(c, decimal_comma).has_value();
  };
  const auto numbers = std::count_if(cells.begin(), cells.end(), is_number);
  if (2 * static_cast<std::size_t>(numbers) < cells.size()) return;
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (!to_number(cells[c], decimal_comma))
      throw TableError(fmt::format("{}: column {}: {}", place, c + 1, why_no_number(cells[c])));
}

void check_names(const std::vector<std::string>& names, bool decimal_comma,
                 const std::string& place) {
  std::set<std::string_view> seen;
  for (const std::string& name : names) {
    const std::string_view plain = split_heading(name).name;
    if (!name.empty() && seen.insert(plain).second) continue;
    refuse_bad_number(names, decimal_comma, place);
    if (name.empty()) throw TableError(place + ": a column has no name");
    throw TableError(fmt::format("{}: two columns are called '{}'", place, plain));
  }
}

/// Separators at the end of a row, as spreadsheets leave them, make no column.
void drop_empty_end(std::vector<std::string>& cells, std::size_t columns) {
  while (cells.size() > columns && cells.back().empty()) cells.pop_back();
}

/// What may have gone wrong in a row with too many cells: ", is 1,234.5 one number?" or nothing.
std::string thousands_hint(const std::vector<std::string>& cells) {
  for (std::size_t c = 1; c < cells.size(); ++c) {
    const std::string joined = cells[c - 1] + "," + cells[c];
    if (has_thousands(joined))
      return fmt::format("; if '{}' is one number, leave out the comma between thousands", joined);
  }
  return {};
}

void check_encoding(std::string_view& text, const std::string& path) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a spreadsheet's byte order mark
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw TableError(path + ":1: the table is in UTF-16; save it as UTF-8");
}

}  // namespace

Heading split_heading(std::string_view heading) {
  const auto open = heading.find_last_of("[(");
  if (open == std::string_view::npos || open == 0) return {heading, {}};
  if (heading.back() != (heading[open] == '[' ? ']' : ')')) return {heading, {}};
  // "sqrt(g)" is a name.
  if (heading[open] == '(' && !is_blank(heading[open - 1])) return {heading, {}};
  return {trim(heading.substr(0, open)), trim(heading.substr(open + 1, heading.size() - open - 2))};
}

CsvTable parse_csv_table(std::string_view text, const std::string& path, std::size_t max_cells) {
  check_encoding(text, path);
  CsvTable table;
  table.path_ = path;
  Lines lines(text);
  char separator = 0;
  std::size_t nameless = 0;  // cells of the row of names, those without one at its end included
  for (std::string_view line; lines.next(line);) {
    if (const std::string_view words = trim(line); is_comment(words)) {
      table.comments_.emplace_back(trim(words.substr(words.front() == '/' ? 2 : 1)));
      continue;
    }
    const std::string place = fmt::format("{}:{}", path, lines.number());
    if (table.names_.empty()) {
      Lines ahead = lines;
      std::string_view second;
      while (ahead.next(second) && is_comment(trim(second))) second = {};
      separator = separator_of(line, second, place);
      table.decimal_comma_ = separator != ',';
    }
    std::vector<std::string> cells = split(separator == ' ' ? trim(line) : line, separator, place);
    if (table.names_.empty()) {
      if (!all_numbers(cells, table.decimal_comma_)) {
        if (separator == ' ') cells = join_units(std::move(cells));
        nameless = cells.size();
        drop_empty_end(cells, 1);
        check_names(cells, table.decimal_comma_, place);
        table.cells_.resize(cells.size());
        table.names_ = std::move(cells);
        table.header_line_ = lines.number();
        continue;
      }
      table.cells_.resize(cells.size());
      for (std::size_t i = 1; i <= cells.size(); ++i) table.names_.push_back(std::to_string(i));
    }
    drop_empty_end(cells, table.names_.size());
    if (cells.size() > table.names_.size() && cells.size() <= nameless)
      throw TableError(table.header_place() + ": a column has no name");
    if (cells.size() != table.names_.size())
      throw TableError(fmt::format(
          "{}: {} cells, but there are {} columns{}", place, cells.size(), table.names_.size(),
          cells.size() > table.names_.size() ? thousands_hint(cells) : ""));
    if (table.named() &&
        std::all_of(cells.begin(), cells.end(), [](const std::string& c) { return c.empty(); }))
      continue;  // an empty row of a spreadsheet; in a grid it is a row of holes
    if ((table.lines_.size() + 1) * cells.size() > max_cells)
      throw TableError(fmt::format("{}: more than {} cells", place, max_cells));
    for (std::size_t c = 0; c < cells.size(); ++c) table.cells_[c].push_back(std::move(cells[c]));
    table.lines_.push_back(lines.number());
  }
  const auto is_empty = [](const std::string& c) { return c.empty(); };
  while (!table.named() && table.cells_.size() > 1 &&
         std::all_of(table.cells_.back().begin(), table.cells_.back().end(), is_empty)) {
    table.cells_.pop_back();
    table.names_.pop_back();
  }
  if (table.names_.empty()) throw TableError(path + ": the table has no row of column names");
  return table;
}

CsvTable read_csv_table(const std::string& path) {
  return parse_csv_table(read_file(path, max_bytes), path);
}

bool CsvTable::has(std::string_view name) const {
  return std::any_of(names_.begin(), names_.end(), [&](const std::string& n) {
    return n == name || split_heading(n).name == name;
  });
}

std::string CsvTable::place(std::size_t row) const {
  return fmt::format("{}:{}", path_, lines_.at(row));
}

std::string CsvTable::header_place() const { return fmt::format("{}:{}", path_, header_line_); }

void CsvTable::check_headings() const {
  if (named()) refuse_bad_number(names_, decimal_comma_, header_place());
}

std::size_t CsvTable::index(std::string_view name) const {
  for (std::size_t c = 0; c < names_.size(); ++c)
    if (names_[c] == name) return c;
  for (std::size_t c = 0; c < names_.size(); ++c)
    if (split_heading(names_[c]).name == name) return c;
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
    const std::optional<double> value = to_number(cells[r], decimal_comma_);
    if (!value)
      throw TableError(fmt::format("{}: column '{}': {}", place(r), name, why_no_number(cells[r])));
    values.push_back(*value);
  }
  return values;
}

std::vector<double> CsvTable::all_numbers(std::string_view name) const {
  std::vector<double> values = numbers(name);
  for (std::size_t r = 0; r < values.size(); ++r)
    if (std::isnan(values[r]))
      throw TableError(fmt::format("{}: column '{}': the cell is {}", place(r), name,
                                   text(name)[r].empty() ? "empty" : "not a number"));
  return values;
}

CsvTable CsvTable::where(std::string_view name, std::string_view value) const {
  const std::vector<std::string>& keys = text(name);
  const std::optional<double> number = to_number(value);
  CsvTable out;
  out.path_ = path_;
  out.comments_ = comments_;
  out.names_ = names_;
  out.header_line_ = header_line_;
  out.decimal_comma_ = decimal_comma_;
  out.cells_.resize(cells_.size());
  for (std::size_t r = 0; r < rows(); ++r) {
    const std::optional<double> key = number ? to_number(keys[r], decimal_comma_) : std::nullopt;
    if (keys[r] != value && !(key && *key == *number)) continue;
    for (std::size_t c = 0; c < cells_.size(); ++c) out.cells_[c].push_back(cells_[c][r]);
    out.lines_.push_back(lines_[r]);
  }
  return out;
}

}  // namespace sphgeo
