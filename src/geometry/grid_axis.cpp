#include "geometry/grid_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text.h"
#include "deck/table_columns.h"

namespace sphgeo {
namespace {

constexpr double most_lines = 2e7;

// One in the last digit of a number: 0.01 of "1.25", 1e-5 of "1.25e-3", 1 of "7".
double last_digit(std::string_view number) {
  const auto exponent = number.find_first_of("eE");
  const auto point = number.substr(0, exponent).find_first_of(".,");
  double power = 0;
  if (point != std::string_view::npos)
    power = -static_cast<double>(std::min(exponent, number.size()) - point - 1);
  if (exponent != std::string_view::npos) {
    int e = 0;
    const bool negative = number.substr(exponent + 1).starts_with('-');
    for (const char c : number.substr(exponent + 1))
      if (c >= '0' && c <= '9') e = std::min(10 * e + (c - '0'), 1000);
    power += negative ? -e : e;
  }
  return std::pow(10.0, power);
}

double middle(std::vector<double> values) {
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), half, values.end());
  return *half;
}

}  // namespace

GridAxis::GridAxis(const CsvTable& table, const char* column, const std::vector<double>& at)
    : table_(table), column_(column) {
  std::vector<double> sorted = at;
  std::sort(sorted.begin(), sorted.end());
  first = sorted.front();
  const double extent = sorted.back() - first;
  if (extent == 0) return;
  // A file may leave out zeros at the end: its finest number counts.
  last_digit_ = std::numeric_limits<double>::infinity();
  for (const std::string& cell : table.text(column))
    last_digit_ = std::min(last_digit_, last_digit(cell));
  const UnitText unit = column_unit(table, column, unit::length);
  last_digit_ *= unit.factor / unit.divisor;

  double widest = 0;
  for (std::size_t k = 1; k < sorted.size(); ++k)
    widest = std::max(widest, sorted[k] - sorted[k - 1]);
  // Gaps below a thousandth of the widest are those of points on one line.
  std::vector<double> lines{first}, gaps;
  for (const double x : sorted)
    if (const double gap = x - lines.back(); gap > 1e-3 * widest) {
      gaps.push_back(gap);
      lines.push_back(x);
    }
  // Most lines have a neighbor; where many are missing, the closest two show the step.
  const double narrowest = *std::min_element(gaps.begin(), gaps.end());
  if (fit(lines, middle(gaps)) || fit(lines, narrowest)) return;
  if (!(extent / narrowest < most_lines))
    throw TableError(fmt::format("{}: the points lie on no grid along {}", table.path(), column));
  count = static_cast<int>(std::round(extent / narrowest)) + 1;
  step = extent / (count - 1);
  first = sorted.front();
  for (std::size_t row = 0; row < at.size(); ++row) node(at[row], row);
}

bool GridAxis::fit(const std::vector<double>& at, double gap) {
  // The mean of the gaps between neighbors is less rounded than one of them.
  double sum = 0;
  int n = 0;
  for (std::size_t k = 1; k < at.size(); ++k)
    if (const double g = at[k] - at[k - 1]; std::abs(g - gap) < 0.5 * gap) {
      sum += g;
      ++n;
    }
  if (n > 0) gap = sum / n;
  std::vector<double> line{0};
  for (std::size_t k = 1; k < at.size(); ++k)
    line.push_back(line.back() + std::max(1.0, std::round((at[k] - at[k - 1]) / gap)));
  const double lines = line.back();
  if (!(lines < most_lines)) return false;
  // How far the coordinates are from lines of this step, at the best place of the first one.
  double lowest = 0, highest = 0;
  const auto off = [&](double trial) {
    lowest = highest = 0;
    for (std::size_t k = 1; k < at.size(); ++k) {
      const double beside = at[k] - at.front() - line[k] * trial;
      lowest = std::min(lowest, beside);
      highest = std::max(highest, beside);
    }
    return 0.5 * (highest - lowest);
  };
  count = static_cast<int>(lines) + 1;
  first = at.front();
  step = (at.back() - at.front()) / lines;
  slack = 0;
  const double at_first = off(step);
  if (at_first <= 1e-9 * (at.back() - at.front()) + 1e-6 * step) return true;
  // Not exact: the step from which they are least far, between bounds beyond which the two ends
  // alone are farther.
  double low = step - 4 * at_first / lines, high = step + 4 * at_first / lines;
  for (int k = 0; k < 100; ++k) {
    const double third = (high - low) / 3;
    if (off(low + third) < off(high - third)) high -= third;
    else low += third;
  }
  step = 0.5 * (low + high);
  const double least = off(step);
  first = at.front() + 0.5 * (lowest + highest);
  slack = last_digit_ / lines;
  return step > 0 && least <= farthest_off();
}

// What the last digit hides, or a hundredth of a step; beyond a fifth of a step it hides the grid.
double GridAxis::farthest_off() const {
  return std::min(std::max(0.01 * step, 0.5 * last_digit_), 0.2 * step) * (1 + 1e-6);
}

int GridAxis::node(double at, std::size_t row) const {
  if (count == 1) return 0;
  const double k = std::round((at - first) / step);
  // Points of one line may be a thousandth of a step apart beside that.
  if (!(std::abs(at - first - k * step) <= farthest_off() + 0.001 * step))
    throw TableError(
        fmt::format("{}: the point at {} = {} m lies on no grid: its neighbors are {} m apart",
                    table_.place(row), column_, exact(at), exact(step)));
  return static_cast<int>(std::clamp(k, 0.0, count - 1.0));
}

}  // namespace sphgeo
