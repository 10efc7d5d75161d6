#include "study/price.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/progress.h"

namespace sphgeo {

namespace {

/// The smallest number 1, 2, 3 or 5 times a power of ten that is not below x; `lower`: the largest
/// not above it.
double round_number(double x, bool lower) {
  const double decade = std::pow(10, std::floor(std::log10(x)));
  constexpr double steps[] = {1, 2, 3, 5, 10};
  double best = lower ? decade : 10 * decade;
  for (const double s : steps) {
    const double candidate = s * decade;
    if (lower ? candidate <= x * (1 + 1e-12) && candidate > best
              : candidate >= x * (1 - 1e-12) && candidate < best)
      best = candidate;
  }
  return best;
}

std::string error_text(double error, const ErrorScale& scale) {
  return scale.relative ? fmt::format("{:.2g} %", 100 * error) : fmt::format("{:.2g}", error);
}

std::string about(double seconds) {
  if (seconds < 10) return fmt::format("about {:.1g} s", seconds);
  if (seconds < 120) return fmt::format("about {:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("about {:.0f} min", seconds / 60);
  if (seconds < 48 * 3600) return fmt::format("about {:.0f} h", seconds / 3600);
  return fmt::format("about {:.0f} days", seconds / 86400);
}

/// A power law through two runs: y = y1 (h / h1)^exponent.
struct PowerLaw {
  double h1, y1, exponent;
  double operator()(double h) const { return y1 * std::pow(h / h1, exponent); }
};

PowerLaw law(double h1, double y1, double h2, double y2) {
  return {h1, y1, std::log(y2 / y1) / std::log(h2 / h1)};
}

struct Point {
  double h, error, wall;
};

}  // namespace

std::vector<bool> worth_their_time(std::span<const Offer> offers) {
  std::vector<bool> worth(offers.size(), false);
  for (std::size_t k = 0; k < offers.size(); ++k) {
    if (!offers[k].error) continue;
    worth[k] = true;
    for (std::size_t other = 0; other < offers.size(); ++other) {
      const Offer& o = offers[other];
      if (other == k || !o.error) continue;
      const bool as_good = *o.error <= *offers[k].error && o.wall_s <= offers[k].wall_s;
      const bool better = *o.error < *offers[k].error || o.wall_s < offers[k].wall_s;
      if (as_good && (better || other < k)) worth[k] = false;
    }
  }
  return worth;
}

std::string price_of_spacing(std::span<const Offer> offers, const ErrorScale& scale) {
  std::vector<Point> points;
  for (const Offer& o : offers)
    if (o.error && std::isfinite(*o.error) && o.wall_s > 0)
      points.push_back({o.spacing, *o.error, o.wall_s});
  if (points.size() < 2) return "a single run with an error: its cost at other errors is unknown";
  const Point first = points.front(), last = points.back();
  const std::string against = scale.reference.empty() ? "" : " against " + scale.reference;
  if (!(last.error < first.error) || !(last.error > 0)) {
    std::string text =
        fmt::format("the error{} does not fall: {} at dp {:g} ({}), {} at dp {:g} ({})", against,
                    error_text(first.error, scale), first.h, about(first.wall),
                    error_text(last.error, scale), last.h, about(last.wall));
    return text;
  }
  // Beyond the finest run: the order of all errors, and the growth of time between the two finest
  // runs, where the start-up time has the smallest share. An order above two is chance at one
  // spacing, not a property of the kernel sums.
  PowerLaw error_law = law(last.h, last.error, first.h, first.error);
  const bool lucky = error_law.exponent > 2;
  error_law.exponent = std::min(error_law.exponent, 2.0);
  const Point& before = points[points.size() - 2];
  const PowerLaw time_law = law(last.h, last.wall, before.h, before.wall);

  const auto spacing_for = [&](double error) -> std::optional<double> {
    // From the finest: the largest spacing below which no run is worse.
    if (error < last.error) {
      const double h = last.h * std::pow(error / last.error, 1 / error_law.exponent);
      return h >= last.h / 4 ? std::optional<double>(h) : std::nullopt;
    }
    for (std::size_t k = points.size() - 1; k > 0; --k) {
      const Point &fine = points[k], &coarse = points[k - 1];
      if (coarse.error <= error) continue;
      const PowerLaw between = law(fine.h, fine.error, coarse.h, coarse.error);
      return fine.h * std::pow(error / fine.error, 1 / between.exponent);
    }
    return points.front().h;
  };
  const auto wall_for = [&](double h) {
    for (std::size_t k = 1; k < points.size(); ++k)
      if (h >= points[k].h)
        return law(points[k].h, points[k].wall, points[k - 1].h, points[k - 1].wall)(h);
    return time_law(h);
  };

  std::vector<double> wanted = {round_number(last.error, false),
                                round_number(last.error / 2, true)};
  if (scale.tolerance > 0) wanted.push_back(scale.tolerance);
  std::sort(wanted.begin(), wanted.end(), std::greater<>());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::vector<std::string> said;
  for (const double error : wanted) {
    const std::string what =
        error_text(error, scale) + (error == scale.tolerance ? " (the deck's tolerance)" : "");
    const std::optional<double> h = spacing_for(error);
    if (!h) said.push_back(what + " is out of reach of these runs");
    else if (*h >= first.h)
      said.push_back(fmt::format("{} is met by the coarsest, dp {:.3g} ({})", what, first.h,
                                 about(first.wall)));
    else
      said.push_back(fmt::format("{} needs {}dp {:.2g} ({})", what, *h < last.h ? "about " : "", *h,
                                 about(wall_for(*h))));
  }
  std::string text;
  for (const std::string& s : said) text += (text.empty() ? "" : "; ") + s;
  return lucky ? text + "; the finest error may be small by chance" : text;
}

std::string price_of_settings(std::span<const Offer> offers, const ErrorScale& scale) {
  std::string text;
  const Offer *cheapest = nullptr, *best = nullptr;
  for (const Offer& o : offers) {
    if (!o.error) continue;
    text += fmt::format("{}{}: {} in {}", text.empty() ? "" : "; ", o.setting,
                        error_text(*o.error, scale), about(o.wall_s).substr(6));
    if (!best || *o.error < *best->error) best = &o;
    if (scale.tolerance > 0 && *o.error <= scale.tolerance &&
        (!cheapest || o.wall_s < cheapest->wall_s))
      cheapest = &o;
  }
  if (!best) return "no run has an error";
  if (cheapest)
    return text + fmt::format("; the cheapest within tolerance is {}", cheapest->setting);
  return text + fmt::format("; the most accurate is {}", best->setting);
}

}  // namespace sphgeo
