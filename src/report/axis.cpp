#include "report/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/markup.h"

namespace sphgeo {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// A mark nearer to an end than this fraction of the mark distance lies on it.
constexpr double nearness = 1e-6;

/// The smallest of 1, 2, 5, 10 times a power of ten that is not below `least`.
double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least * (1 - nearness)) return factor * power;
  return 10 * power;
}

}  // namespace

std::vector<double> linear_ticks(double low, double high, int most) {
  if (!std::isfinite(low) || !std::isfinite(high) || !(high > low) || most < 1) return {};
  const double step = round_step((high - low) / most);
  if (!(step > 0) || low + step == low || !std::isfinite(step)) return {low, high};
  const double first = std::ceil(low / step - nearness), last = std::floor(high / step + nearness);
  std::vector<double> ticks;
  for (double k = first; k <= last; ++k) ticks.push_back(k == 0 ? 0.0 : k * step);
  return ticks;
}

std::vector<double> log_ticks(double low, double high, int most) {
  if (!(low > 0) || !std::isfinite(high) || !(high > low) || most < 1) return {};
  const double decades = std::log10(high / low);
  const int first = static_cast<int>(std::floor(std::log10(low) + nearness));
  const int last = static_cast<int>(std::ceil(std::log10(high) - nearness));
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / most)));
  std::vector<double> ticks;
  const auto add = [&](double value) {
    if (value >= low * (1 - nearness) && value <= high * (1 + nearness)) ticks.push_back(value);
  };
  for (int e = first; e <= last; ++e) {
    if (e % stride != 0) continue;
    add(std::pow(10.0, e));
    if (decades < 2)
      for (const double factor : {2.0, 5.0}) add(factor * std::pow(10.0, e));
  }
  // Less than a factor of two or so: the marks of a linear axis serve as well.
  return ticks.size() < 2 ? linear_ticks(low, high, most) : ticks;
}

AxisScale::AxisScale(const ChartAxis& axis, double low, double high, int most_ticks) : axis_(axis) {
  const bool log = axis.log;
  if (!std::isfinite(low) || !std::isfinite(high) || low > high || (log && !(low > 0))) {
    low = log ? 0.1 : 0.0;
    high = 1.0;
  }
  if (log) {
    const double margin = std::max(std::pow(high / low, 0.05), 1.1);
    low_ = axis.low && *axis.low > 0 ? *axis.low : low / margin;
    high_ = axis.high && *axis.high > low_ ? *axis.high : std::max(high * margin, 2 * low_);
    ticks_ = log_ticks(low_, high_, most_ticks);
    return;
  }
  // A constant gets a scale of its own magnitude, not of its round-off.
  const double span = std::max(high - low, 1e-9 * std::max(std::abs(low), std::abs(high)));
  const double margin = span > 0 ? 0.04 * span : 0.5;
  const bool flat = !(high - low > 1e-9 * std::max(std::abs(low), std::abs(high)));
  const double room = flat && high != 0 ? 0.1 * std::abs(high) : margin;
  low_ = axis.low.value_or(low >= 0 && low < 0.3 * high ? 0.0 : low - room);
  high_ = axis.high.value_or(high <= 0 && high > 0.3 * low ? 0.0 : high + room);
  if (!(high_ > low_)) high_ = low_ + 1;
  ticks_ = linear_ticks(low_, high_, most_ticks);
  double largest = 0;
  for (const double t : ticks_) largest = std::max(largest, std::abs(t));
  if (largest >= 1e4 || (largest > 0 && largest < 1e-2))
    power_ = 3 * static_cast<int>(std::floor(std::log10(largest * (1 + nearness)) / 3));
  const double step = ticks_.size() > 1 ? (ticks_[1] - ticks_[0]) / std::pow(10.0, power_) : 1.0;
  decimals_ = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - nearness)), 0, 12);
}

double AxisScale::position(double value) const {
  if (!std::isfinite(value)) return nan;
  if (!axis_.log) return (value - low_) / (high_ - low_);
  return value > 0 ? std::log(value / low_) / std::log(high_ / low_) : nan;
}

std::string AxisScale::text(double tick) const {
  if (axis_.log) {
    const double exponent = std::log10(tick);
    const bool decade = std::abs(exponent - std::round(exponent)) < nearness;
    if (decade && (tick >= 9999 || tick < 2e-3))
      return "10" + raised(static_cast<int>(std::lround(exponent)));
    return number_text(tick, 3);
  }
  const std::string digits =
      fmt::format("{:.{}f}", std::abs(tick) / std::pow(10.0, power_), decimals_);
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  return (tick < 0 && !zero ? "−" : "") + digits;
}

std::string AxisScale::title() const {
  const std::string unit = unit_text(axis_.unit);
  std::string factor = power_ == 0 ? "" : "10" + raised(power_);
  if (!factor.empty() && !unit.empty()) factor += "\u00a0";
  const std::string bracket = factor + unit;
  if (bracket.empty() || axis_.title.empty()) return axis_.title + bracket;
  return axis_.title + " (" + bracket + ")";
}

}  // namespace sphgeo
