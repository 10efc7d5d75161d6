#pragma once
// The lines of a regular grid on which the coordinates of points lie.

#include <string>
#include <vector>

#include "core/csv_table.h"

namespace sphgeo {

/// A grid along one axis, as a column of coordinates gives it: some lines may be missing, and the
/// coordinates may be rounded as far as the digits of the file show.
struct GridAxis {
  double first = 0, step = 0;  ///< m
  int count = 1;               ///< of lines
  double slack = 0;            ///< by which the rounding leaves the step open, m

  /// `at` are the numbers of the column in metres. Throws TableError, with the line of a point that
  /// lies beside the grid, when they lie on none.
  GridAxis(const CsvTable& table, const char* column, const std::vector<double>& at);

  /// The line of a coordinate of the column.
  int node(double at, std::size_t row) const;

 private:
  // Lays the lines through sorted coordinates that are about `gap` apart, and fits them. Whether
  // all then lie on lines.
  bool fit(const std::vector<double>& at, double gap);
  double farthest_off() const;

  const CsvTable& table_;
  const char* column_;
  double last_digit_ = 0;  // one in the last digit that the file shows, m
};

}  // namespace sphgeo
