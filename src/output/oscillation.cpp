// The period of an oscillation from its samples; declared in output/reduction.h.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "output/reduction.h"

namespace sphgeo {

namespace {

/// Fraction of the root mean square that a curve must pass on both sides of zero for one crossing.
constexpr double hysteresis = 0.3;

/// A line y = offset + slope * t.
struct Trend {
  double offset = 0, slope = 0;
  double operator()(double t) const { return offset + slope * t; }
};

/// Crossings of zero with an index that counts equal distances: rising and falling ones apart,
/// since an offset moves them in opposite directions.
struct Crossings {
  std::vector<double> rising, falling;
};

double weight(const Samples& s, std::size_t i) {
  const std::size_t before = i == 0 ? i : i - 1;
  const std::size_t after = std::min(i + 1, s.t.size() - 1);
  return 0.5 * (s.t[after] - s.t[before]);
}

/// Time-weighted mean, the first guess of the trend.
Trend mean_trend(const Samples& s) {
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    sum += weight(s, i) * s.y[i];
    weights += weight(s, i);
  }
  return {weights > 0 ? sum / weights : 0, 0};
}

/// The trend of y = trend + (growing or decaying) oscillation of the given period, by least
/// squares. With few periods in the window the amplitude is taken as constant, as the fit would be
/// degenerate.
Trend fitted_trend(const Samples& s, double period) {
  const double begin = s.t.front();
  const double span = s.t.back() - begin;
  const int terms = span / period > 2.9 ? 6 : span / period > 1.4 ? 4 : 3;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms, terms);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(terms);
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    const double u = 2 * (s.t[i] - begin) / span - 1;
    const double phase = 2 * std::numbers::pi * (s.t[i] - begin) / period;
    const double c = std::cos(phase), d = std::sin(phase);
    Eigen::VectorXd basis(terms);
    if (terms == 6) basis << 1, c, d, u, u * c, u * d;
    else if (terms == 4) basis << 1, c, d, u;
    else basis << 1, c, d;
    normal += weight(s, i) * basis * basis.transpose();
    right += weight(s, i) * s.y[i] * basis;
  }
  const Eigen::VectorXd fit = normal.ldlt().solve(right);
  const double slope = terms > 3 ? 2 * fit[3] / span : 0;
  const double offset = fit[0] - (terms > 3 ? fit[3] : 0) - slope * begin;
  return {offset, slope};
}

Crossings crossings(const Samples& s, const Trend& trend) {
  std::vector<double> y(s.y.size());
  double squares = 0, weights = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i] = s.y[i] - trend(s.t[i]);
    squares += weight(s, i) * y[i] * y[i];
    weights += weight(s, i);
  }
  const double band = hysteresis * std::sqrt(squares / weights);
  Crossings found;
  int side = 0;                 // the side on which the curve last left the band
  std::vector<double> passing;  // zeros since then; noise makes several, their mean is taken
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (i > 0 && (y[i - 1] < 0) != (y[i] < 0))
      passing.push_back(s.t[i - 1] + (s.t[i] - s.t[i - 1]) * y[i - 1] / (y[i - 1] - y[i]));
    const int now = y[i] > band ? 1 : y[i] < -band ? -1 : 0;
    if (now == 0) continue;
    if (side == -now && !passing.empty()) {
      double mean = 0;
      for (const double t : passing) mean += t / static_cast<double>(passing.size());
      (now > 0 ? found.rising : found.falling).push_back(mean);
    }
    side = now;
    passing.clear();
  }
  return found;
}

/// Least squares of time over index, one common distance for both directions.
std::optional<double> distance(const Crossings& c) {
  double kk = 0, kt = 0;
  for (const std::vector<double>* times : {&c.rising, &c.falling}) {
    const auto n = static_cast<double>(times->size());
    double mean = 0;
    for (const double t : *times) mean += t / n;
    for (std::size_t k = 0; k < times->size(); ++k) {
      const double index = static_cast<double>(k) - 0.5 * (n - 1);
      kk += index * index;
      kt += index * ((*times)[k] - mean);
    }
  }
  if (!(kk > 0) || !(kt > 0)) return {};
  return kt / kk;
}

}  // namespace

std::optional<double> oscillation_period(const Samples& s) {
  if (s.t.size() < 5 || !(s.t.back() > s.t.front())) return {};
  // A strong drift hides the crossings with the mean: try the line through the ends as well.
  const double slope = (s.y.back() - s.y.front()) / (s.t.back() - s.t.front());
  std::optional<double> period = distance(crossings(s, mean_trend(s)));
  if (!period) period = distance(crossings(s, {s.y.front() - slope * s.t.front(), slope}));
  for (int pass = 0; pass < 4 && period; ++pass) {
    const std::optional<double> better = distance(crossings(s, fitted_trend(s, *period)));
    if (!better) break;
    period = better;
  }
  return period;
}

}  // namespace sphgeo
