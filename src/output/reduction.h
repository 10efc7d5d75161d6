#pragma once
// Time series reduced to one number, and compared with reference curves.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sphgeo {

/// Samples of one quantity: times (s, never falling) and values; NaN where there was no support.
struct Samples {
  std::vector<double> t, y;
};

/// The samples with support and with from <= t <= to. Values at the very ends of the window are
/// interpolated, so that the result does not depend on the sampling times.
Samples cut(std::span<const double> t, std::span<const double> y, std::optional<double> from,
            std::optional<double> to);

/// The names that reduce() knows, for the deck: last, first, min, max, max_abs, mean, rms, range,
/// time_of_max, time_of_min, period, frequency, slope, at.
std::span<const std::string_view> reduction_names();

/// The samples (without NaN, see cut) as one number; `at` is the time (s) for the reduction "at".
/// Means are means over time of the piecewise linear curve. Empty when the samples do not hold such
/// a number (no samples, fewer than two periods' crossings, a time outside). Throws
/// std::invalid_argument for an unknown name.
std::optional<double> reduce(const Samples& samples, std::string_view name,
                             std::optional<double> at = {});

/// The value of the piecewise linear curve at a time; empty outside of the samples.
std::optional<double> interpolate(const Samples& samples, double time);

/// The mean period of an oscillation (s): crossings of the curve with its own trend, found with a
/// hysteresis against noise and fitted to equal distances. The trend is fitted together with the
/// oscillation, since a trend fitted alone would be tilted by the part of the last period.
/// Empty when there are not two crossings in the same direction.
std::optional<double> oscillation_period(const Samples& samples);

/// Difference of a curve from a table.
struct CurveDifference {
  double l2 = 0;           ///< root mean square of the difference by the range of the reference
  double max = 0;          ///< largest difference by the range of the reference
  double relative_l2 = 0;  ///< root mean square of the difference by that of the reference
  int used = 0;            ///< points of the reference inside of the samples
  int skipped = 0;         ///< points of the reference that the samples do not reach
};

/// Compares at the abscissae x of the reference (NaN points are ignored). Empty when no point can
/// be used. Of a constant reference only relative_l2 is finite.
std::optional<CurveDifference> compare_curve(const Samples& samples, std::span<const double> x,
                                             std::span<const double> y);

}  // namespace sphgeo
