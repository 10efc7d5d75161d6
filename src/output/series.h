#pragma once
// The samples of one probe: kept in memory for `expect`, written to a CSV file as they come.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/column.h"
#include "output/csv.h"

namespace sphgeo {

/// Rows of (time, values) with named columns. A value that is not finite means "no support": an
/// empty cell, never zero.
class Series {
 public:
  /// `columns` without the time, which comes first by itself.
  Series(std::string name, std::vector<Column> columns);

  /// Appends all rows from now on to a new CSV file. Throws IoError.
  void write_to(const std::string& path, double flush_seconds = 1.0);
  /// Continues a CSV file: reads its rows up to `offset` bytes back into memory, drops the rest,
  /// and appends from there. Throws IoError when the file does not fit, TableError when it is
  /// damaged.
  void resume(const std::string& path, std::uint64_t offset, double flush_seconds = 1.0);

  /// One value a column; times never fall. Throws std::invalid_argument, IoError.
  void add(double time, std::span<const double> values);
  /// As add(), where an empty optional means "no support".
  void add(double time, std::span<const std::optional<double>> values);

  /// Hands the rows to the system; returns the bytes of the file (0 without a file) for a
  /// checkpoint.
  std::uint64_t flush(bool to_disk = false);
  /// Waits until what flush() has handed over is on the disk; in any thread, while rows are added.
  void wait_for_disk() const;

  const std::string& name() const { return name_; }
  const std::vector<Column>& columns() const { return columns_; }
  std::span<const double> times() const { return times_; }
  std::span<const double> column(std::size_t index) const { return values_.at(index); }
  bool has(std::string_view column) const;
  /// Throws std::out_of_range when there is no such column.
  std::span<const double> column(std::string_view name) const;

 private:
  std::vector<Column> csv_columns() const;

  std::string name_;
  std::vector<Column> columns_;
  std::vector<double> times_;
  std::vector<std::vector<double>> values_;  ///< by column; NaN = no support
  std::optional<CsvWriter> csv_;
  std::vector<double> row_;  ///< scratch
};

}  // namespace sphgeo
