#include "output/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/atomic_file.h"
#include "core/csv_table.h"
#include "core/error.h"

namespace sphgeo {

Series::Series(std::string name, std::vector<Column> columns)
    : name_(std::move(name)), columns_(std::move(columns)), values_(columns_.size()) {}

std::vector<Column> Series::csv_columns() const {
  std::vector<Column> all = {{"time", "s", "simulated time of the sample"}};
  all.insert(all.end(), columns_.begin(), columns_.end());
  return all;
}

void Series::write_to(const std::string& path, double flush_seconds) {
  csv_.emplace(path, name_, csv_columns(), flush_seconds);
}

void Series::resume(const std::string& path, std::uint64_t offset, double flush_seconds) {
  csv_ = CsvWriter::resume(path, name_, csv_columns(), offset, flush_seconds);
  try {
    const CsvTable table = read_csv_table(path);
    times_ = table.numbers(table.names().front());
    for (std::size_t c = 0; c < columns_.size(); ++c)
      values_[c] = table.numbers(table.names()[c + 1]);
  } catch (const TableError& e) {
    throw IoError(path, std::string("changed since it was written: ") + e.what());
  }
  for (std::size_t k = 0; k < times_.size(); ++k)
    if (!std::isfinite(times_[k]) || (k > 0 && times_[k] < times_[k - 1]))
      throw IoError(
          path,
          fmt::format(
              "changed since it was written: the time of row {} is before that of the previous row",
              k + 1));
}

void Series::add(double time, std::span<const double> values) {
  if (values.size() != columns_.size())
    throw std::invalid_argument(
        fmt::format("probe '{}': {} values for {} columns", name_, values.size(), columns_.size()));
  if (!std::isfinite(time) || (!times_.empty() && time < times_.back()))
    throw std::invalid_argument(fmt::format("probe '{}': time {} after {}", name_, time,
                                            times_.empty() ? 0.0 : times_.back()));
  times_.push_back(time);
  for (std::size_t c = 0; c < values.size(); ++c)
    values_[c].push_back(std::isfinite(values[c]) ? values[c]
                                                  : std::numeric_limits<double>::quiet_NaN());
  if (!csv_) return;
  row_.assign(1, time);
  row_.insert(row_.end(), values.begin(), values.end());
  csv_->row(row_);
}

void Series::add(double time, std::span<const std::optional<double>> values) {
  std::vector<double> plain;
  for (const std::optional<double>& v : values)
    plain.push_back(v.value_or(std::numeric_limits<double>::quiet_NaN()));
  add(time, std::span<const double>(plain));
}

std::uint64_t Series::flush(bool to_disk) {
  if (!csv_) return 0;
  csv_->flush(to_disk);
  return csv_->offset();
}

void Series::wait_for_disk() const {
  if (csv_) csv_->wait_for_disk();
}

bool Series::has(std::string_view column) const {
  return std::any_of(columns_.begin(), columns_.end(),
                     [&](const Column& c) { return c.name == column; });
}

std::span<const double> Series::column(std::string_view name) const {
  for (std::size_t c = 0; c < columns_.size(); ++c)
    if (columns_[c].name == name) return values_[c];
  throw std::out_of_range(fmt::format("probe '{}' has no column '{}'", name_, name));
}

}  // namespace sphgeo
