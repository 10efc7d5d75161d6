#pragma once
// Reads tables of reference values and of results.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace sphgeo {

/// A table cannot be used as asked; the message begins with file:line.
class TableError : public Error {
 public:
  explicit TableError(const std::string& what) : Error(ExitCode::usage, what) {}
};

/// A CSV table: `#` comment lines, one row of column names, rows of cells. Cells are separated by
/// commas and may be quoted; an empty cell and `nan` mean "no value" (NaN). When the first row
/// holds numbers only, there are no names and the columns are called "1", "2", ...
class CsvTable {
 public:
  /// All column names, as written (a unit in brackets included).
  const std::vector<std::string>& names() const { return names_; }
  /// The comment lines without their `#`.
  const std::vector<std::string>& comments() const { return comments_; }
  std::size_t rows() const { return lines_.size(); }
  const std::string& path() const { return path_; }

  /// Whether there is such a column; "p" finds "p" and "p [Pa]".
  bool has(std::string_view name) const;
  /// The numbers of a column, NaN for empty cells. Throws TableError when there is no such column
  /// (it lists those there are) or when a cell is not a number (with its line).
  std::vector<double> numbers(std::string_view name) const;
  /// The cells of a column as text. Throws TableError when there is no such column.
  const std::vector<std::string>& text(std::string_view name) const;
  /// The rows whose cell in the column is this text, or this number.
  CsvTable where(std::string_view name, std::string_view value) const;

 private:
  friend CsvTable parse_csv_table(std::string_view text, const std::string& path,
                                  std::size_t max_cells);
  std::size_t index(std::string_view name) const;

  std::string path_;
  std::vector<std::string> comments_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> cells_;  ///< by column
  std::vector<int> lines_;                       ///< the line of each row
};

/// Parses the text of a table of at most 4096 columns; `path` is for the messages. Throws
/// TableError with file:line.
CsvTable parse_csv_table(std::string_view text, const std::string& path,
                         std::size_t max_cells = 20'000'000);

/// Reads a table of at most 256 MB. Throws IoError or TableError.
CsvTable read_csv_table(const std::string& path);

}  // namespace sphgeo
