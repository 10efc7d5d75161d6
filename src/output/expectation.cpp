#include "output/expectation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "deck/model.h"
#include "deck/reference_curve.h"
#include "output/reduction.h"
#include "output/series.h"

namespace sphgeo {

namespace {

/// "front" or "front.x": the probe and its column; a probe's own name may hold dots.
struct Source {
  const Series* series = nullptr;
  std::string column;  ///< empty: the first
};

Source find_source(const std::string& probe, const SeriesLookup& series) {
  if (const Series* whole = series(probe)) return {whole, {}};
  const auto dot = probe.rfind('.');
  if (dot == std::string::npos) return {};
  return {series(probe.substr(0, dot)), probe.substr(dot + 1)};
}

void measure_number(const Expect& e, const Samples& samples, ExpectResult& result) {
  if (const std::optional<double> reduced = reduce(samples, e.reduce, e.at))
    result.value = (*reduced + e.shift) / e.scale;
  else result.note = fmt::format("the {} samples hold no '{}'", samples.t.size(), e.reduce);
}

/// What lies in the window of a claim and is not reached by the samples cannot be met: what is
/// there is measured, and the claim fails.
void measure_curve(const Expect& e, Samples samples, const std::string& unit,
                   ExpectResult& result) {
  auto [x, y] = read_reference(e, unit);
  for (double& v : samples.y) v = (v + e.shift) / e.scale;
  for (double& v : x)  // a point outside of the window is ignored, also for the range
    if ((e.from && v < *e.from) || (e.to && v > *e.to)) v = std::nan("");
  // Round-off at the ends is no difference of range.
  if (!samples.t.empty())
    for (double& v : x)
      for (const double bound : {samples.t.front(), samples.t.back()})
        if (std::abs(v - bound) < 1e-9 * (samples.t.back() - samples.t.front())) v = bound;
  const std::optional<CurveDifference> d = compare_curve(samples, x, y);
  if (!d) {
    result.note = "no point of the reference can be compared";
    return;
  }
  result.value = e.norm == "max" ? d->max : e.norm == "relative_l2" ? d->relative_l2 : d->l2;
  if (d->skipped == 0) return;
  result.partial = true;
  result.note = fmt::format(
      "{} of {} points of the reference lie outside of the samples, which reach from {:.4g} to "
      "{:.4g} {}{}",
      d->skipped, d->used + d->skipped, samples.t.front(), samples.t.back(),
      e.reduce == "profile" ? "m" : "s",
      e.reduce == "profile" ? "" : ": 'from' and 'to' say which part is claimed");
}

/// The value of a column at a time, between two rows that both have one.
std::optional<double> value_at(const Series& series, std::size_t column, double time) {
  const auto t = series.times();
  const auto after = std::lower_bound(t.begin(), t.end(), time);
  if (after == t.end()) return {};
  const auto k = static_cast<std::size_t>(after - t.begin());
  const auto values = series.column(column);
  if (t[k] == time) return std::isfinite(values[k]) ? std::optional(values[k]) : std::nullopt;
  if (k == 0) return {};
  const double share = (time - t[k - 1]) / (t[k] - t[k - 1]);
  const double value = (1 - share) * values[k - 1] + share * values[k];
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// The heights of a profile at one time, over the distance along its line; NaN where there is none.
Samples profile(const Expect& e, const Series& series) {
  Samples out;
  if (series.times().empty()) return out;
  for (std::size_t k = 0; k < series.columns().size(); ++k) {
    if (!series.columns()[k].along) continue;
    out.t.push_back(*series.columns()[k].along);
    out.y.push_back(
        value_at(series, k, e.at.value_or(series.times().back())).value_or(std::nan("")));
  }
  return out;
}

void judge(const Expect& e, ExpectResult& result) {
  if (!result.value || !std::isfinite(*result.value)) return;
  const double value = *result.value;
  if (e.measure == "above") {
    result.pass = value >= e.tolerance && !result.partial;
  } else if (e.measure == "below" || e.reference_csv) {
    result.error = value;
    result.pass = value <= e.tolerance && !result.partial;
  } else if (!e.reference) {
    result.note = "there is no reference to compare with";
  } else {
    const bool relative = e.tolerance_kind == "relative";
    if (relative && *e.reference == 0) {
      result.note = "a relative tolerance of a reference of zero: set tolerance_kind: absolute";
      return;
    }
    result.error = std::abs(value - *e.reference) / (relative ? std::abs(*e.reference) : 1.0);
    result.pass = *result.error <= e.tolerance;
  }
}

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : std::string("-");
}

}  // namespace

ExpectResult evaluate(const Expect& e, const SeriesLookup& series) {
  ExpectResult result;
  result.name = e.name;
  result.reference = e.reference;
  result.tolerance = e.tolerance;
  const Source source = find_source(e.probe, series);
  if (!source.series) {
    result.note = fmt::format("no probe '{}'", e.probe);
    return result;
  }
  if (!source.column.empty() && !source.series->has(source.column)) {
    result.note =
        fmt::format("probe '{}' has no column '{}'", source.series->name(), source.column);
    return result;
  }
  const std::vector<Column>& columns = source.series->columns();
  const auto column = source.column.empty()
                          ? columns.begin()
                          : std::find_if(columns.begin(), columns.end(),
                                         [&](const Column& c) { return c.name == source.column; });
  const auto index = static_cast<std::size_t>(column - columns.begin());
  const auto values = source.series->column(index);
  const auto times = source.series->times();
  const double end = times.empty() ? 0 : std::min(times.back(), e.to.value_or(times.back()));
  const Samples samples = cut(source.series->times(), values, e.from, e.to);
  try {
    if (const bool last = e.reduce == "last"; last || e.reduce == "at") {
      const double when = last ? end : *e.at;
      if (!times.empty() && !value_at(*source.series, index, when)) {
        result.note =
            fmt::format("there is no value at t = {:.6g} s{}", when, last ? ", the end" : "");
        return result;
      }
    }
    if (e.reduce == "profile") measure_curve(e, profile(e, *source.series), column->unit, result);
    else if (e.reduce == "curve") measure_curve(e, samples, column->unit, result);
    else measure_number(e, samples, result);
  } catch (const Error& error) {  // an unreadable reference must not discard the results of the run
    result.note = error.what();
  }
  judge(e, result);
  return result;
}

std::vector<ExpectResult> evaluate(std::span<const Expect> expects, const SeriesLookup& series) {
  std::vector<ExpectResult> results;
  for (const Expect& e : expects) results.push_back(evaluate(e, series));
  return results;
}

std::string render_expectations(std::span<const ExpectResult> results) {
  std::size_t width = 6;
  for (const ExpectResult& r : results) width = std::max(width, r.name.size());
  std::string out = fmt::format("  {:<{}}  {:>12}  {:>12}  {:>12}  {:>12}\n", "expect", width,
                                "value", "reference", "error", "tolerance");
  for (const ExpectResult& r : results) {
    out +=
        fmt::format("  {:<{}}  {:>12}  {:>12}  {:>12}  {:>12}  {}\n", r.name, width, cell(r.value),
                    cell(r.reference), cell(r.error), cell(r.tolerance), r.pass ? "pass" : "FAIL");
    if (!r.note.empty()) out += fmt::format("  {:<{}}  ({})\n", "", width, printable(r.note));
  }
  return out;
}

}  // namespace sphgeo
