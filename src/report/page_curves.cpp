// The sections of a report that are curves: claims against their references, probes, energies,
// steps.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/text.h"
#include "deck/reference_curve.h"
#include "report/chart.h"
#include "report/markup.h"
#include "report/page_parts.h"

namespace sphgeo {

namespace {

/// Charts one after another until they take too many bytes; what is left out is counted.
class Charts {
 public:
  explicit Charts(std::size_t most_bytes) : most_(most_bytes) {}

  void add(const Chart& chart, const std::string& caption = {}) {
    if (html_.size() > most_) {
      ++left_out_;
      return;
    }
    html_ += "<figure>" + chart_svg(chart) +
             (caption.empty() ? "" : "<figcaption>" + html_escaped(caption) + "</figcaption>") +
             "</figure>\n";
  }

  std::string html() const {
    if (html_.empty()) return {};
    return "<div class=\"charts\">\n" + html_ + "</div>\n" +
           (left_out_ > 0 ? fmt::format("<p class=\"quiet\">{} further curves are left out; they "
                                        "are in the folder probes.</p>\n",
                                        left_out_)
                          : "");
  }

 private:
  std::size_t most_;
  std::string html_;
  int left_out_ = 0;
};

/// One axis of time for all charts of the page.
ChartAxis time_axis(Runs runs) {
  ChartAxis axis{"time", "s", false, {}, {}};
  if (std::all_of(runs.begin(), runs.end(), is_relaxation)) axis = {"step", "", false, {}, {}};
  for (const RunRecord& run : runs) {
    if (!run.run || run.run->time.empty()) continue;
    axis.low = std::min(axis.low.value_or(run.run->time.front()), run.run->time.front());
    axis.high = std::max(axis.high.value_or(run.run->time.back()), run.run->time.back());
  }
  return axis;
}

/// Fraction of the kernel that was filled: useful beside the values in the file, not as a curve.
constexpr std::string_view support_column = "support";

/// The probe and column that a claim names: "front" or "front.x"; a probe's own name may hold dots.
std::pair<const TimeSeries*, const NamedColumn*> find_column(const RunRecord& run,
                                                             const std::string& source) {
  if (const TimeSeries* whole = run.series(source))
    return {whole, whole->columns.empty() ? nullptr : &whole->columns.front()};
  const auto dot = source.rfind('.');
  if (dot == std::string::npos) return {};
  const TimeSeries* series = run.series(source.substr(0, dot));
  return {series, series ? series->find(source.substr(dot + 1)) : nullptr};
}

/// The reference of a curve, as it is compared. Empty when it cannot be read: the table of claims
/// says why.
std::optional<ChartCurve> reference_curve(const Expect& e, const std::string& unit) {
  try {
    ReferenceCurve reference = read_reference(e, unit);
    ChartCurve curve;
    curve.x = std::move(reference.x);
    curve.y = std::move(reference.y);
    curve.name = "reference";
    curve.line = false;
    curve.markers = curve.neutral = true;
    return curve;
  } catch (const Error&) {
    return {};
  }
}

/// Claims that compare with a curve, each with its reference.
void add_claims(Runs runs, Charts& charts, std::set<std::string>& shown) {
  for (const RunRecord& first : runs) {
    if (!first.model) continue;
    for (const Expect& e : first.model->expect) {
      if (e.reduce != "curve" || !e.reference_csv || shown.contains("claim " + e.name)) continue;
      Chart chart;
      chart.title = e.name;
      chart.x = time_axis(runs);
      const bool raw = e.scale == 1 && e.shift == 0;
      std::string unit;
      for (const RunRecord& run : runs) {
        const auto [series, column] = find_column(run, e.probe);
        if (!column) continue;
        unit = column->unit;
        std::string name = column->name;
        std::replace(name.begin(), name.end(), '_', ' ');
        chart.y.title = raw ? name
                        : e.shift == 0
                            ? name + " / " + number_text(e.scale) +
                                  (column->unit.empty() ? "" : " " + unit_text(column->unit))
                            : name + ", scaled";
        chart.y.unit = raw ? column->unit : "";
        ChartCurve curve;
        curve.name = runs.size() > 1 ? run.label : e.probe;
        curve.x = series->time;
        curve.y = column->values;
        for (double& v : curve.y) v = (v + e.shift) / e.scale;
        chart.curves.push_back(std::move(curve));
      }
      if (chart.curves.empty()) continue;
      if (auto reference = reference_curve(e, unit)) chart.curves.push_back(std::move(*reference));
      shown.insert("claim " + e.name);
      std::string window;
      if (e.from || e.to)
        window = fmt::format("; compared from {} to {}",
                             e.from ? number_text(*e.from) + " s" : "the start",
                             e.to ? number_text(*e.to) + " s" : "the end");
      charts.add(chart, e.source + window);
    }
  }
}

/// Of the columns of a probe with this unit at most as many as a chart can tell apart, evenly
/// chosen.
std::vector<std::string> chosen_columns(const TimeSeries& probe, const std::string& unit,
                                        std::size_t& all) {
  constexpr std::size_t most = 6;
  std::vector<std::string> names, chosen;
  for (const NamedColumn& c : probe.columns)
    if (c.unit == unit && c.name != support_column) names.push_back(c.name);
  all = names.size();
  for (std::size_t k = 0; k < std::min(most, all); ++k)
    chosen.push_back(names[all <= most ? k : k * (all - 1) / (most - 1)]);
  return chosen;
}

/// Columns of one probe that share a unit, in one chart; with several runs a chart a column.
void add_probe(Runs runs, const std::string& probe, const std::string& unit,
               std::vector<std::string> columns, std::string caption, Charts& charts) {
  // Columns that are zero at all times, where others are not, are named in the text.
  const auto zero = [&](const std::string& column) {
    const TimeSeries* series = runs.front().series(probe);
    const NamedColumn* c = series ? series->find(column) : nullptr;
    return c && std::all_of(c->values.begin(), c->values.end(),
                            [](double v) { return v == 0 || std::isnan(v); });
  };
  const auto first_zero = std::stable_partition(columns.begin(), columns.end(),
                                                [&](const std::string& c) { return !zero(c); });
  if (first_zero != columns.begin() && first_zero != columns.end()) {
    caption += (caption.empty() ? "zero: " : "; zero: ") + in_words({first_zero, columns.end()});
    columns.erase(first_zero, columns.end());
  }
  Chart chart;
  chart.x = time_axis(runs);
  std::string name = columns.front();
  std::replace(name.begin(), name.end(), '_', ' ');
  chart.title = columns.size() == 1 ? probe + ": " + name : probe;
  chart.y = {columns.size() == 1 ? name : "", unit, false, {}, {}};
  for (const RunRecord& run : runs)
    for (const std::string& column : columns) {
      const TimeSeries* series = run.series(probe);
      const NamedColumn* c = series ? series->find(column) : nullptr;
      if (!c) continue;
      ChartCurve curve;
      curve.name = columns.size() > 1 ? column : runs.size() > 1 ? run.label : "";
      curve.x = series->time;
      curve.y = c->values;
      chart.curves.push_back(std::move(curve));
    }
  charts.add(chart, caption);
}

void add_probes(Runs runs, Charts& charts) {
  std::set<std::pair<std::string, std::string>> done;  // probe, unit
  for (const RunRecord& first : runs)
    for (const TimeSeries& probe : first.probes)
      for (const NamedColumn& column : probe.columns) {
        if (column.name == support_column || !done.emplace(probe.name, column.unit).second)
          continue;
        std::size_t all = 0;
        const std::vector<std::string> columns = chosen_columns(probe, column.unit, all);
        const std::string caption =
            columns.size() < all ? fmt::format("{} of {} columns", columns.size(), all) : "";
        if (runs.size() == 1) add_probe(runs, probe.name, column.unit, columns, caption, charts);
        else
          for (const std::string& one : columns)
            add_probe(runs, probe.name, column.unit, {one}, caption, charts);
      }
}

ChartCurve change_of(const TimeSeries& run, const std::string& column, bool since_start) {
  ChartCurve curve;
  curve.name = column;
  const NamedColumn* c = run.find(column);
  if (!c || c->values.empty()) return curve;
  curve.x = run.time;
  curve.y = c->values;
  const double start = c->values.front();
  if (since_start)
    for (double& v : curve.y) v -= start;
  return curve;
}

/// Energies of one run; potential energy has no natural zero, so that all are changes since the
/// start.
void add_energies(Runs runs, const RunRecord& run, Charts& charts) {
  const bool several = runs.size() > 1;
  Chart chart;
  chart.title = several ? "energies of " + run.label : "energies, change since the start";
  chart.x = time_axis(runs);
  chart.y = {"change of energy", "J", false, {}, {}};
  ChartCurve sum;
  sum.name = "sum";
  sum.neutral = sum.dashed = true;
  for (const char* column : {"kinetic", "potential", "internal", "dissipated"}) {
    ChartCurve curve = change_of(*run.run, column, true);
    if (curve.x.empty()) continue;
    sum.x = curve.x;
    sum.y.resize(curve.y.size(), 0.0);
    for (std::size_t i = 0; i < curve.y.size(); ++i) sum.y[i] += curve.y[i];
    chart.curves.push_back(std::move(curve));
  }
  if (chart.curves.empty()) return;
  chart.curves.push_back(std::move(sum));
  charts.add(chart);
}

void add_columns(Runs runs, const std::string& title,
                 const std::vector<std::pair<std::string, std::string>>& columns, bool log,
                 Charts& charts) {
  Chart chart;
  chart.title = title;
  chart.x = time_axis(runs);
  for (const RunRecord& run : runs) {
    if (!run.run) continue;
    for (const auto& [column, name] : columns) {
      ChartCurve curve = change_of(*run.run, column, false);
      if (curve.x.empty()) continue;
      curve.name = runs.size() > 1      ? (columns.size() > 1 ? run.label + ", " + name : run.label)
                   : columns.size() > 1 ? name
                                        : "";
      chart.y.unit = run.run->find(column)->unit;
      chart.curves.push_back(std::move(curve));
    }
  }
  chart.y.title = title;
  chart.y.log = log;
  if (!chart.curves.empty()) charts.add(chart);
}

}  // namespace

std::string curves_html(Runs runs, std::size_t most_bytes) {
  Charts charts(most_bytes);
  std::set<std::string> shown;
  add_claims(runs, charts, shown);
  add_probes(runs, charts);
  return charts.html();
}

std::string conservation_html(Runs runs) {
  Charts charts(200'000);
  for (const RunRecord& run : runs)
    if (run.run) add_energies(runs, run, charts);
  add_columns(runs, "largest speed", {{"max_speed", ""}}, false, charts);
  add_columns(runs, "time step", {{"dt_advection", "advection"}, {"dt_acoustic", "acoustic"}}, true,
              charts);
  return ledger_html(runs) + guard_html(runs) +
         (charts.html().empty() ? "" : "<h3>Over time</h3>\n" + charts.html());
}

}  // namespace sphgeo
