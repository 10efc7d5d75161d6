#pragma once
// Axes of charts: positions and texts of the marks.

#include <optional>
#include <string>
#include <vector>

namespace sphgeo {

struct ChartAxis {
  std::string title;
  std::string unit;  ///< SI; "" or "1" = none
  bool log = false;
  std::optional<double> low, high;  ///< ends of the axis; empty: from the curves
};

/// Values for the marks of a linear axis from `low` to `high`, both ends inside: multiples of 1, 2
/// or 5 times a power of ten, about `most` of them and never more than `most` + 1.
std::vector<double> linear_ticks(double low, double high, int most = 6);

/// Values for the marks of a logarithmic axis: powers of ten (of a thousand ... when there are
/// many), and 2 and 5 times them where the axis spans less than two decades.
std::vector<double> log_ticks(double low, double high, int most = 7);

/// An axis with its ends: from values to positions along it.
class AxisScale {
 public:
  /// `low` and `high` are the extremes of the data (any when there is none); ends that the axis
  /// itself names win. Without them the ends lie a little outside of the data, on zero where that
  /// is near.
  AxisScale(const ChartAxis& axis, double low, double high, int most_ticks);

  /// 0 at the low end, 1 at the high end, outside of them beyond; NaN for what the axis cannot
  /// show.
  double position(double value) const;
  const std::vector<double>& ticks() const { return ticks_; }
  /// The text at a mark; of a linear axis without the power of ten that its title names.
  std::string text(double tick) const;
  /// "pressure (10³ Pa)"; without a title "10³ Pa".
  std::string title() const;

 private:
  ChartAxis axis_;
  double low_ = 0, high_ = 1;
  std::vector<double> ticks_;
  int power_ = 0;     ///< of ten, taken out of the texts of a linear axis
  int decimals_ = 0;  ///< of the texts of a linear axis
};

}  // namespace sphgeo
