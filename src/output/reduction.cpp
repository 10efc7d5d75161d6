#include "output/reduction.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sphgeo {

namespace {

constexpr std::array<std::string_view, 15> names = {
    "last",   "first",       "min",         "max",    "max_abs",   "mean",  "rms", "range",
    "growth", "time_of_max", "time_of_min", "period", "frequency", "slope", "at"};

/// The integral over time of a quadratic form of the piecewise linear curve, by the span of time.
/// `piece(a, b)` is the mean of the form over one piece with the end values a and b.
template <class Piece>
double mean_of(const Samples& s, Piece piece) {
  double integral = 0;
  for (std::size_t i = 1; i < s.t.size(); ++i)
    integral += (s.t[i] - s.t[i - 1]) * piece(s.y[i - 1], s.y[i]);
  const double span = s.t.back() - s.t.front();
  return span > 0 ? integral / span : piece(s.y.back(), s.y.back());
}

/// The largest rise above the lowest value that came before.
double growth(const Samples& s) {
  double lowest = s.y.front(), most = 0;
  for (const double y : s.y) {
    lowest = std::min(lowest, y);
    most = std::max(most, y - lowest);
  }
  return most;
}

/// Slope of the least-squares line.
std::optional<double> slope(const Samples& s) {
  const auto n = static_cast<double>(s.t.size());
  double mean_t = 0, mean_y = 0, tt = 0, ty = 0;
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    mean_t += s.t[i] / n;
    mean_y += s.y[i] / n;
  }
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    tt += (s.t[i] - mean_t) * (s.t[i] - mean_t);
    ty += (s.t[i] - mean_t) * (s.y[i] - mean_y);
  }
  if (!(tt > 0)) return {};
  return ty / tt;
}

}  // namespace

std::span<const std::string_view> reduction_names() { return names; }

Samples cut(std::span<const double> t, std::span<const double> y, std::optional<double> from,
            std::optional<double> to) {
  Samples all;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!std::isfinite(y[i])) continue;
    all.t.push_back(t[i]);
    all.y.push_back(y[i]);
  }
  if (!from && !to) return all;
  const double begin = from.value_or(-std::numeric_limits<double>::infinity());
  const double end = to.value_or(std::numeric_limits<double>::infinity());
  Samples out;
  const auto add = [&](double time, std::optional<double> value) {
    if (!value || (!out.t.empty() && out.t.back() == time)) return;
    out.t.push_back(time);
    out.y.push_back(*value);
  };
  if (from && end >= begin) add(begin, interpolate(all, begin));
  for (std::size_t i = 0; i < all.t.size(); ++i)
    if (all.t[i] >= begin && all.t[i] <= end) add(all.t[i], all.y[i]);
  if (to && end >= begin) add(end, interpolate(all, end));
  return out;
}

std::optional<double> interpolate(const Samples& s, double time) {
  if (s.t.empty() || time < s.t.front() || time > s.t.back()) return {};
  const auto after = std::lower_bound(s.t.begin(), s.t.end(), time);
  const auto i = static_cast<std::size_t>(after - s.t.begin());
  if (s.t[i] == time) return s.y[i];
  const double w = (time - s.t[i - 1]) / (s.t[i] - s.t[i - 1]);
  return (1 - w) * s.y[i - 1] + w * s.y[i];
}

std::optional<double> reduce(const Samples& s, std::string_view name, std::optional<double> at) {
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw std::invalid_argument(fmt::format("no reduction is called '{}'", name));
  if (s.t.empty()) return {};
  const auto lowest = std::min_element(s.y.begin(), s.y.end());
  const auto highest = std::max_element(s.y.begin(), s.y.end());
  if (name == "last") return s.y.back();
  if (name == "first") return s.y.front();
  if (name == "min") return *lowest;
  if (name == "max") return *highest;
  if (name == "max_abs") return std::max(std::abs(*lowest), std::abs(*highest));
  if (name == "range") return *highest - *lowest;
  if (name == "growth") return growth(s);
  if (name == "time_of_max") return s.t[static_cast<std::size_t>(highest - s.y.begin())];
  if (name == "time_of_min") return s.t[static_cast<std::size_t>(lowest - s.y.begin())];
  if (name == "mean") return mean_of(s, [](double a, double b) { return 0.5 * (a + b); });
  if (name == "rms")
    return std::sqrt(mean_of(s, [](double a, double b) { return (a * a + a * b + b * b) / 3; }));
  if (name == "slope") return slope(s);
  if (name == "at") return at ? interpolate(s, *at) : std::nullopt;
  const std::optional<double> period = oscillation_period(s);
  if (!period || name == "period") return period;
  return 1 / *period;
}

std::optional<CurveDifference> compare_curve(const Samples& s, std::span<const double> x,
                                             std::span<const double> y) {
  CurveDifference d;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  double squares = 0, reference = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    lowest = std::min(lowest, y[i]);
    highest = std::max(highest, y[i]);
    const std::optional<double> value = interpolate(s, x[i]);
    if (!value || std::isnan(*value)) {
      ++d.skipped;
      continue;
    }
    ++d.used;
    squares += (*value - y[i]) * (*value - y[i]);
    reference += y[i] * y[i];
    d.max = std::max(d.max, std::abs(*value - y[i]));
  }
  const double range = highest - lowest;
  if (d.used == 0) return {};
  // Of a constant reference only relative_l2 is finite.
  d.l2 = std::sqrt(squares / d.used) / range;
  d.relative_l2 = std::sqrt(squares / reference);
  d.max /= range;
  return d;
}

}  // namespace sphgeo
