#pragma once
// Rows of numbers, written during a run.

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/column.h"

namespace sphgeo {

/// Writes a CSV file: `#` lines (title and one legend line a column with unit and sentence), a row
/// of headings "pressure [Pa]", then one row a call. Numbers are the shortest that read back to the
/// same bits; a value that is not finite is an empty cell. Rows reach the file together, at the
/// latest with the first row after `flush_seconds` of wall time, and always whole rows: when the
/// disk is full the file is cut back to its last whole row. Every failure is an IoError.
class CsvWriter {
 public:
  /// Starts a new file, replacing an old one. `flush_seconds` = 0 writes every row at once.
  CsvWriter(const std::string& path, const std::string& title, const std::vector<Column>& columns,
            double flush_seconds = 1.0);

  /// Continues a file of the same title and columns after its first `offset` bytes and drops the
  /// rest. Throws IoError when the file is shorter or has another head.
  static CsvWriter resume(const std::string& path, const std::string& title,
                          const std::vector<Column>& columns, std::uint64_t offset,
                          double flush_seconds = 1.0);

  CsvWriter(CsvWriter&& other) noexcept;
  CsvWriter& operator=(CsvWriter&& other) noexcept;
  /// Writes what is left; a failure here is silent, so call flush() before.
  ~CsvWriter();

  /// One value a column. Throws std::invalid_argument when the number of values is wrong.
  void row(std::span<const double> values);

  /// Hands all rows to the system; with `to_disk` also waits for the disk.
  void flush(bool to_disk = false);
  /// Waits until what the system was handed is on the disk; in any thread, while rows are added.
  void wait_for_disk() const;

  /// Bytes of the head and of all rows so far, flushed or not: a checkpoint keeps it after flush().
  std::uint64_t offset() const { return flushed_ + pending_.size(); }
  const std::string& path() const { return path_; }

 private:
  CsvWriter(const std::string& path, std::size_t columns, double flush_seconds);
  void close() noexcept;

  std::string path_;
  std::size_t columns_;
  double flush_seconds_;
  int descriptor_ = -1;
  std::string pending_;
  std::uint64_t flushed_ = 0;
  std::chrono::steady_clock::time_point last_flush_ = std::chrono::steady_clock::now();
};

/// The `#` lines and the row of headings.
std::string csv_head(const std::string& title, const std::vector<Column>& columns);

/// A cell that is written between commas: quoted when it must be.
std::string csv_cell(std::string_view text);

}  // namespace sphgeo
