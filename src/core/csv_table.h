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

/// The heading of a column, "p [Pa]" or "p (Pa)": its name and the text of its unit, "" without.
struct Heading {
  std::string_view name, unit;
};
Heading split_heading(std::string_view heading);

/// A table of cells: comment lines (`#`, `%` or `//`), one row of column names, rows of cells.
/// Cells are separated by semicolons, tabs, commas or blanks, by what the first row shows, and may
/// be quoted; where no comma separates them, numbers may have a decimal comma. Lines end in LF, CR
/// LF or CR. An empty cell and `nan` mean "no value" (NaN). When the first row holds numbers only,
/// there are no names and the columns are called "1", "2", ... Separators at the end of rows make
/// no column, and a row of empty cells below names is no row.
class CsvTable {
 public:
  /// All column names, as written (a unit in brackets included).
  const std::vector<std::string>& names() const { return names_; }
  /// The comment lines without their `#`.
  const std::vector<std::string>& comments() const { return comments_; }
  /// Whether the table has a row of column names.
  bool named() const { return header_line_ > 0; }
  std::size_t rows() const { return lines_.size(); }
  /// "file:line" of a row, and of the row of column names.
  std::string place(std::size_t row) const;
  std::string header_place() const;
  const std::string& path() const { return path_; }

  /// Throws TableError when most column names are numbers: then the first row is one of numbers, of
  /// which one cannot be read, and the message says which.
  void check_headings() const;

  /// Whether there is such a column; "p" finds "p" and "p [Pa]".
  bool has(std::string_view name) const;
  /// The numbers of a column, NaN for empty cells. Throws TableError when there is no such column
  /// (it lists those there are) or when a cell is not a number (with its line).
  std::vector<double> numbers(std::string_view name) const;
  /// The same without "no value": an empty cell is an error too, with its line.
  std::vector<double> all_numbers(std::string_view name) const;
  /// The heading of a column as written. Throws TableError when there is no such column.
  const std::string& heading(std::string_view name) const { return names_[index(name)]; }
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
  int header_line_ = 0;                          ///< of the column names; 0: there are none
  bool decimal_comma_ = false;
};

/// Parses the text of a table of at most 4096 columns; `path` is for the messages. Throws
/// TableError with file:line.
CsvTable parse_csv_table(std::string_view text, const std::string& path,
                         std::size_t max_cells = 20'000'000);

/// Reads a table of at most 256 MB. Throws IoError or TableError.
CsvTable read_csv_table(const std::string& path);

}  // namespace sphgeo
