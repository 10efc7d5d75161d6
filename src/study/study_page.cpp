// A study as a page.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/cost_figures.h"
#include "report/chart.h"
#include "report/markup.h"
#include "report/page_parts.h"
#include "study/study.h"

namespace sphgeo {

namespace {

/// The results of one claim: its curves.
using Curves = std::span<const StudyResult>;

std::string curve_name(const StudyResult& r) {
  return r.curve->others.empty() ? r.curve->key
                                 : r.curve->key + ", " + settings_text(r.curve->others);
}

/// Error against wall time, both in logarithms.
std::string diagram(Curves curves, const StudyClaim& claim) {
  Chart chart;
  chart.x = {"wall time", "s", true, {}, {}};
  chart.y = {
      claim.relative ? "error" : "error (as the result)", claim.relative ? "%" : "", true, {}, {}};
  const double unit = claim.relative ? 100 : 1;
  std::vector<std::pair<double, double>> front;
  for (const StudyResult& r : curves) {
    ChartCurve curve;
    curve.name = curve_name(r);
    curve.markers = true;
    for (std::size_t k = 0; k < r.runs.size(); ++k) {
      curve.x.push_back(r.runs[k]->record.wall_s);
      curve.y.push_back(r.errors[k] ? unit * *r.errors[k] : std::nan(""));
      curve.labels.push_back(setting_of(*r.runs[k], r.curve->key));
      if (r.worth[k] && (curves.size() == 1 || r.error_against == "the reference"))
        front.emplace_back(curve.x.back(), curve.y.back());
    }
    chart.curves.push_back(std::move(curve));
  }
  if (claim.tolerance > 0 && !chart.curves.empty()) {
    double least = INFINITY, most = 0;
    for (const ChartCurve& c : chart.curves)
      for (const double x : c.x) {
        least = std::min(least, x);
        most = std::max(most, x);
      }
    ChartCurve line{
        "the deck's tolerance", {least, most}, {unit * claim.tolerance, unit * claim.tolerance}};
    line.dashed = line.neutral = true;
    chart.curves.push_back(std::move(line));
  }
  if (front.size() > 1) {
    std::sort(front.begin(), front.end());
    ChartCurve line{"no run is better and faster", {}, {}};
    for (const auto& [x, y] : front) {
      line.x.push_back(x);
      line.y.push_back(y);
    }
    line.emphasised = line.neutral = true;
    chart.curves.insert(chart.curves.begin(), std::move(line));
  }
  return "<figure>" + chart_svg(chart) + "</figure>\n";
}

std::string result_table(const StudyResult& r, const StudyClaim& claim) {
  const std::string head = "<tr>" + head_cell(html_escaped(r.curve->key)) +
                           head_cell("dp [m]", "n") + head_cell("value", "n") +
                           head_cell("error", "n") + head_cell("") + head_cell("wall time", "n") +
                           head_cell("forecast", "n") + head_cell("particles", "n") +
                           head_cell("steps", "n") + head_cell("memory", "n") + "</tr>";
  std::string rows;
  for (std::size_t k = 0; k < r.runs.size(); ++k) {
    const RunOutcome& run = r.runs[k]->record;
    rows +=
        "<tr>" + cell(html_escaped(setting_of(*r.runs[k], r.curve->key))) +
        number_cell(r.runs[k]->spacing) + number_cell(r.values[k].value, "", 0, 6) +
        cell(html_escaped(error_cell(r.errors[k], claim.relative)), "n") +
        cell(fmt::format("<span class=\"badge {}\">{}</span>", r.values[k].pass ? "good" : "bad",
                         r.values[k].pass ? "pass" : "fail")) +
        cell(wall_text(run.wall_s), "n") +
        cell(run.forecast_wall_s ? wall_text(*run.forecast_wall_s) : "–", "n") +
        cell(count_text(static_cast<double>(run.particles)), "n") +
        cell(count_text(static_cast<double>(run.acoustic_steps)), "n") +
        cell(html_escaped(bytes_text(run.memory_bytes)), "n") + "</tr>\n";
  }
  return table("", head, rows);
}

std::string result_section(Curves curves, const StudyClaim& claim) {
  std::string html;
  for (const StudyResult& r : curves) {
    if (curves.size() > 1) html += "<h3>" + html_escaped(curve_name(r)) + "</h3>\n";
    html += "<p><strong>" + html_escaped(r.price) + ".</strong></p>\n";
    if (!r.runs.empty()) html += result_table(r, claim);
    for (const std::string& run : r.left_out)
      html += "<p class=\"quiet\">left out: " + html_escaped(run) + "</p>\n";
    if (r.by_spacing)
      html += "<p class=\"quiet\">" + html_escaped(convergence_text(r.convergence)) + "</p>\n";
  }
  std::string title = html_escaped(claim.name);
  if (const auto reference = curves.front().reference())
    title += " <small>reference " + number_text(*reference, 6) + "</small>";
  const bool drawn = std::any_of(curves.begin(), curves.end(),
                                 [](const StudyResult& r) { return !r.runs.empty(); });
  return section(
      title, (drawn ? "<div class=\"charts\">" + diagram(curves, claim) + "</div>\n" : "") + html);
}

std::string runs_table(const Study& study) {
  const std::string head = "<tr>" + head_cell("run") + head_cell("status") +
                           head_cell("wall time", "n") + head_cell("threads", "n") + "</tr>";
  std::string rows;
  for (const StudyRun& run : study.runs)
    rows += "<tr>" +
            cell(html_escaped(settings_text(run.settings)) +
                 small_text(html_escaped(run.record.message))) +
            cell(html_escaped(run.record.status)) + cell(wall_text(run.record.wall_s), "n") +
            cell(std::to_string(run.record.threads), "n") + "</tr>\n";
  return table("slim", head, rows);
}

}  // namespace

std::string study_page(const Study& study, const std::vector<StudyResult>& results) {
  std::string page =
      page_head(study.title.empty() ? study.deck : study.title,
                fmt::format("<p class=\"quiet\">Accuracy against time: {}, {}, {}, sphgeo {}</p>\n",
                            html_escaped(study.deck), html_escaped(study.date),
                            html_escaped(study.machine), html_escaped(study.version)));
  for (const StudyClaim& claim : study.claims) {
    const auto first = std::find_if(results.begin(), results.end(),
                                    [&](const StudyResult& r) { return r.name == claim.name; });
    const auto last = std::find_if(first, results.end(),
                                   [&](const StudyResult& r) { return r.name != claim.name; });
    if (first != last) page += result_section({first, last}, claim);
  }
  page += section("Runs", runs_table(study));
  const std::string json =
      to_json(study, results)
          .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return page + "</main>\n<script type=\"application/json\" id=\"study\">" + script_escaped(json) +
         "</script>\n</body>\n</html>\n";
}

}  // namespace sphgeo
