#include "compare/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/hash.h"
#include "core/parallel.h"
#include "core/text.h"

namespace sphgeo {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Positions of a set that are compared with the other run: enough for a mean, few enough for sets
/// of millions.
constexpr std::size_t most_positions = 2000;

struct Span {
  double least = infinite, most = -infinite;
  void add(double v) {
    if (!std::isfinite(v)) return;
    least = std::min(least, v);
    most = std::max(most, v);
  }
  double size() const { return most > least ? most - least : 0; }
  double largest() const { return most >= least ? std::max(std::abs(least), std::abs(most)) : 0; }
};

/// What is smaller than this share of its companions is noise about zero.
constexpr double least_share = 0.01;

/// Sums the differences of pairs of values; a pair of which only one is a number is counted apart.
struct Mismatch {
  double squares = 0, used = 0, unlike = 0;
  void add(double x, double y) {
    if (std::isfinite(x) != std::isfinite(y)) unlike += 1;
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    squares += (x - y) * (x - y);
    used += 1;
  }
  /// The root mean square; zero where it is what the seven digits of baselines leave out of values
  /// of this size.
  double rms(double largest) const {
    const double value = used > 0 ? std::sqrt(squares / used) : 0;
    return value <= 1e-6 * largest ? 0 : value;
  }
};

std::string vector_of(const std::string& field) { return field.substr(0, field.find('.')); }

Span span_of(const std::vector<double>& values) {
  Span span;
  for (const double v : values) span.add(v);
  return span;
}

/// A difference over the scale; for a scale of zero any difference counts as 1.
double share(double difference, double scale) {
  if (difference == 0) return 0;
  return scale > 0 ? difference / scale : infinite;
}

class Comparison {
 public:
  Comparison(const RunData& run, const RunData& base, const Tolerances& tolerances)
      : run_(run), base_(base), tolerances_(tolerances) {}

  std::vector<RunDifference> operator()() {
    const bool same = run_.status == base_.status;
    found_.push_back({"status", "", same ? 0 : infinite, 0, same,
                      same ? "" : run_.status + ", was " + base_.status});
    compare_steps();
    compare_probes();
    compare_sets();
    compare_ledger();
    compare_results();
    std::stable_sort(
        found_.begin(), found_.end(),
        [](const RunDifference& a, const RunDifference& b) { return severity(a) > severity(b); });
    return std::move(found_);
  }

 private:
  /// Above 1: fails.
  static double severity(const RunDifference& d) {
    if (d.kind == "new") return -1;
    if (std::isinf(d.tolerance)) return 0;
    if (d.tolerance == 0) return d.difference == 0 ? 0 : infinite;
    return d.difference / d.tolerance;
  }

  void add(const std::string& kind, const std::string& name, double difference,
           std::string note = {}) {
    const double tolerance = tolerances_.of(kind, name);
    found_.push_back({kind, name, difference, tolerance, difference <= tolerance, std::move(note)});
  }
  void missing(const std::string& kind, const std::string& name) {
    found_.push_back(
        {"missing", kind + " " + name, infinite, 0, false, "only the baseline has it"});
  }
  void added(const std::string& kind, const std::string& name) {
    found_.push_back({"new", kind + " " + name, 0, 0, true, "only the run has it"});
  }

  /// Calls `both(run's, base's)` for what stands in both under the same name, and reports the rest.
  template <class List, class Name, class Both>
  void match(const std::string& kind, const List& run, const List& base, Name&& name, Both&& both) {
    for (const auto& b : base) {
      const auto at =
          std::find_if(run.begin(), run.end(), [&](const auto& r) { return name(r) == name(b); });
      if (at == run.end()) missing(kind, name(b));
      else both(*at, b);
    }
    for (const auto& r : run)
      if (std::none_of(base.begin(), base.end(), [&](const auto& b) { return name(r) == name(b); }))
        added(kind, name(r));
  }

  void compare_steps() {
    match(
        "steps", run_.steps, base_.steps, [](const auto& s) { return s.first; },
        [&](const auto& r, const auto& b) {
          add("steps", b.first, share(std::abs(r.second - b.second), b.second),
              fmt::format("{:.0f}, was {:.0f}", r.second, b.second));
        });
  }

  void compare_probes() {
    match(
        "probe", run_.probes, base_.probes,
        [](const ProbeCurve& c) { return c.probe + "." + c.column; },
        [&](const ProbeCurve& r, const ProbeCurve& b) {
          const CurveDistance d = curve_distance(r, b);
          double scale = d.range;
          for (const ProbeCurve& other : base_.probes)
            if (other.probe == b.probe && other.unit == b.unit)
              scale = std::max(scale, least_share * span_of(other.y).size());
          const std::string name = b.probe + "." + b.column;
          std::string note = fmt::format("range {:.4g}", d.range);
          if (d.unsupported > 0)
            note += fmt::format("; at {:.3g} % of the times only one of them has a value",
                                100 * d.unsupported);
          add("probe", name, std::max(share(d.rms, scale), d.unsupported), note);
        });
  }

  void compare_sets() {
    match(
        "set", run_.sets, base_.sets, [](const SetState& s) { return s.set; },
        [&](const SetState& r, const SetState& b) {
          const double change = static_cast<double>(std::abs(r.particles - b.particles));
          add("particles", b.set, share(change, static_cast<double>(b.particles)),
              fmt::format("{}, were {}", r.particles, b.particles));
          if (b.positions.empty()) return;
          if (r.positions.empty()) return missing("particles of", b.set);
          compare_fields(r, b);
        });
  }

  void compare_fields(const SetState& r, const SetState& b) {
    std::vector<std::size_t> sample;
    for (std::size_t k = 0; k < b.positions.size(); ++k)
      if (b.positions.size() <= most_positions ||
          random_bits(2, k) % b.positions.size() < most_positions)
        sample.push_back(k);
    std::vector<Vec3> positions;
    for (const std::size_t k : sample) positions.push_back(b.positions[k]);
    const std::vector<std::size_t> nearest = nearest_positions(positions, r.positions);
    double sum = 0;
    for (std::size_t k = 0; k < positions.size(); ++k)
      sum += (positions[k] - r.positions[nearest[k]]).norm();
    const double mean = sum / static_cast<double>(positions.size());
    add("positions", b.set, base_.resolution > 0 ? mean / base_.resolution : mean,
        fmt::format("mean {:.3g} m", mean));
    match(
        "field", r.fields, b.fields, [&](const FieldState& f) { return b.set + "." + f.name; },
        [&](const FieldState& fr, const FieldState& fb) {
          const Span range = span_of(fb.values);
          double scale = range.size();
          for (const FieldState& other : b.fields)
            if (vector_of(other.name) == vector_of(fb.name))
              scale = std::max(scale, least_share * span_of(other.values).size());
          Mismatch m;
          for (std::size_t k = 0; k < sample.size(); ++k)
            m.add(fr.values[nearest[k]], fb.values[sample[k]]);
          std::string note = fmt::format("range {:.4g}", range.size());
          if (m.unlike > 0)
            note += fmt::format("; {:.0f} particles have a value in only one", m.unlike);
          add("field", b.set + "." + fb.name,
              std::max(share(m.rms(range.largest()), scale),
                       m.unlike / static_cast<double>(sample.size())),
              note);
        });
  }

  void compare_ledger() {
    match(
        "ledger", run_.ledger, base_.ledger, [](const auto& row) { return row.first; },
        [&](const auto& r, const auto& b) {
          Span size;
          for (const auto* values : {&b.second.initial, &b.second.final})
            for (const double v : *values) size.add(v);
          double worst = r.second.final.size() == b.second.final.size() ? 0 : infinite;
          for (std::size_t k = 0; k < std::min(r.second.final.size(), b.second.final.size()); ++k) {
            const double x = r.second.final[k], y = b.second.final[k];
            if (std::isfinite(x) != std::isfinite(y)) worst = infinite;
            else if (std::isfinite(x)) worst = std::max(worst, std::abs(x - y));
          }
          // Rounding of the baseline, and momentum that is zero but for rounding.
          if (worst <= 1e-6 * size.largest() || worst <= 1e-12) worst = 0;
          add("ledger", b.first, share(worst, size.largest()),
              fmt::format("size {:.4g}", size.largest()));
        });
  }

  void compare_results() {
    match(
        "result", run_.results, base_.results, [](const auto& row) { return row.first; },
        [&](const auto& r, const auto& b) {
          const ResultState &now = r.second, &then = b.second;
          std::string note =
              fmt::format("{}, was {}", now.value ? fmt::format("{:.6g}", *now.value) : "no value",
                          then.value ? fmt::format("{:.6g}", *then.value) : "none");
          if (now.pass != then.pass)
            note +=
                now.pass ? "; passes now" : "; misses the deck's tolerance, which the baseline met";
          if ((then.pass && !now.pass) || now.value.has_value() != then.value.has_value()) {
            found_.push_back(
                {"result", b.first, infinite, tolerances_.of("result", b.first), false, note});
            return;
          }
          if (!now.value) return add("result", b.first, 0, note);
          double change = std::abs(*now.value - *then.value);
          if (change <= 1e-6 * std::abs(*then.value)) change = 0;
          // A value near zero is compared with the deck's tolerance.
          add("result", b.first, share(change, std::max(std::abs(*then.value), then.tolerance)),
              note);
        });
  }

  const RunData &run_, &base_;
  const Tolerances& tolerances_;
  std::vector<RunDifference> found_;
};

/// The value of the curve at a time, NaN outside of it and beside gaps. `from` moves along with the
/// time.
double at_time(const ProbeCurve& curve, double time, std::size_t& from) {
  const std::vector<double>& t = curve.t;
  if (t.empty()) return std::nan("");
  // The last row of a run that took other steps may lie a step earlier or later.
  if (time >= t.back())
    return time <= t.back() + 0.02 * (t.back() - t.front()) ? curve.y.back() : std::nan("");
  if (time <= t.front())
    return time >= t.front() - 0.02 * (t.back() - t.front()) ? curve.y.front() : std::nan("");
  if (!(time > t.front() && time < t.back())) return std::nan("");  // a time that is not a number
  while (from + 2 < t.size() && t[from + 1] <= time) ++from;
  const double width = t[from + 1] - t[from];
  if (!(width > 0)) return curve.y[from + 1];
  // Baselines hold times to seven digits: what is that near to a row means the row, also beside a
  // gap.
  const double digits = 1e-6 * std::max(std::abs(t.front()), std::abs(t.back()));
  if (time - t[from] <= digits) return curve.y[from];
  if (t[from + 1] - time <= digits) return curve.y[from + 1];
  const double w = (time - t[from]) / width;
  return curve.y[from] + w * (curve.y[from + 1] - curve.y[from]);
}

}  // namespace

CurveDistance curve_distance(const ProbeCurve& run, const ProbeCurve& baseline) {
  Span range;
  Mismatch m;
  std::size_t from = 0;
  for (std::size_t k = 0; k < baseline.t.size(); ++k) {
    range.add(baseline.y[k]);
    m.add(at_time(run, baseline.t[k], from), baseline.y[k]);
  }
  const double n = static_cast<double>(std::max<std::size_t>(1, baseline.t.size()));
  return {m.rms(range.largest()), range.size(), m.unlike / n};
}

std::vector<std::size_t> nearest_positions(const std::vector<Vec3>& positions,
                                           const std::vector<Vec3>& among) {
  std::vector<std::size_t> nearest(positions.size(), 0);
  parallel_for(static_cast<Index>(positions.size()), [&](Index p) {
    const auto k = static_cast<std::size_t>(p);
    double least = infinite;
    for (std::size_t j = 0; j < among.size(); ++j) {
      const double d = (positions[k] - among[j]).squaredNorm();
      if (d < least) {
        least = d;
        nearest[k] = j;
      }
    }
  });
  return nearest;
}

std::vector<RunDifference> compare_runs(const RunData& run, const RunData& baseline,
                                        const Tolerances& tolerances) {
  return Comparison(run, baseline, tolerances)();
}

std::string render_differences(const std::vector<RunDifference>& differences, std::size_t shown) {
  std::size_t width = 4;
  std::size_t passed = 0;
  const auto listed = [&](const RunDifference& d) { return !d.pass || passed < shown; };
  for (const RunDifference& d : differences)
    width = std::max(width, std::min<std::size_t>(40, d.whole_name().size()));
  std::string out =
      fmt::format("  {:<{}}  {:>10}  {:>10}\n", "what", width, "difference", "tolerance");
  for (const RunDifference& d : differences) {
    if (!listed(d)) continue;
    if (d.pass) ++passed;
    out += fmt::format("  {:<{}}  {:>10}  {:>10}  {}{}\n", printable(d.whole_name()), width,
                       fmt::format("{:.3g}", d.difference), fmt::format("{:.3g}", d.tolerance),
                       d.pass ? "pass" : "FAIL",
                       d.note.empty() ? "" : "  (" + printable(d.note) + ")");
  }
  return out;
}

nlohmann::ordered_json to_json(const std::vector<RunDifference>& differences) {
  auto out = nlohmann::ordered_json::array();
  const auto number = [](double v) {
    return std::isfinite(v) ? nlohmann::ordered_json(v) : nlohmann::ordered_json(nullptr);
  };
  for (const RunDifference& d : differences)
    out.push_back({{"kind", d.kind},
                   {"name", d.name},
                   {"difference", number(d.difference)},
                   {"tolerance", number(d.tolerance)},
                   {"pass", d.pass},
                   {"note", d.note}});
  return out;
}

}  // namespace sphgeo
