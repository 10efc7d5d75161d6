// A study as text and as JSON.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "output/cost_figures.h"
#include "output/progress.h"
#include "study/study.h"

namespace sphgeo {

namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

/// A setting as a number where it is one.
Json setting_json(const std::string& text) {
  const Json parsed = Json::parse(text, nullptr, false);
  return parsed.is_number() ? parsed : Json(text);
}

Json settings_json(const std::vector<Setting>& settings) {
  Json out = Json::object();
  for (const auto& [key, value] : settings) out[key] = setting_json(value);
  return out;
}

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "-";
}

std::string seconds_text(double seconds) {
  return seconds < 10 ? fmt::format("{:.2f} s", seconds) : duration_text(seconds);
}

}  // namespace

const StudyClaim& claim_of(const Study& study, const std::string& name) {
  return *std::find_if(study.claims.begin(), study.claims.end(),
                       [&](const StudyClaim& c) { return c.name == name; });
}

std::string error_cell(const std::optional<double>& error, bool relative) {
  if (!error) return "-";
  return relative ? fmt::format("{:.3g} %", 100 * *error) : fmt::format("{:.4g}", *error);
}

std::string convergence_text(const Convergence& c) {
  std::string text = c.label;
  if (c.order) text += fmt::format("; order {:.2f} (from the {})", *c.order, c.order_from);
  if (c.extrapolated) text += fmt::format("; Richardson {:.6g}", *c.extrapolated);
  if (c.gci) text += fmt::format("; GCI {:.2g} %", 100 * *c.gci);
  return text;
}

Json to_json(const Study& study, const std::vector<StudyResult>& results) {
  Json out;
  out["deck"] = study.deck;
  out["title"] = study.title;
  out["date"] = study.date;
  out["machine"] = study.machine;
  out["version"] = study.version;
  out["varied"] = Json::array();
  for (const Variation& v : study.varied) {
    Json values = Json::array();
    for (const std::string& value : v.values) values.push_back(setting_json(value));
    out["varied"].push_back({{"key", v.key}, {"values", std::move(values)}});
  }
  out["runs"] = Json::array();
  for (const StudyRun& run : study.runs) {
    const RunOutcome& r = run.record;
    Json row = {{"settings", settings_json(run.settings)},
                {"folder", run.folder},
                {"resolution", run.spacing},
                {"status", r.status}};
    if (!r.message.empty()) row["message"] = r.message;
    row["wall_s"] = r.wall_s;
    row["threads"] = r.threads;
    row["particles"] = r.particles;
    row["acoustic_steps"] = r.acoustic_steps;
    row["memory_peak_bytes"] = r.memory_bytes;
    row["forecast"] = {{"wall_s", number(r.forecast_wall_s)},
                       {"memory_bytes", number(r.forecast_memory_bytes)}};
    out["runs"].push_back(std::move(row));
  }
  out["results"] = Json::array();
  for (const StudyResult& r : results) {
    const StudyClaim& claim = claim_of(study, r.name);
    Json row = {{"name", r.name}, {"key", r.curve->key}};
    if (!r.curve->others.empty()) row["settings"] = settings_json(r.curve->others);
    row["reference"] = number(r.reference());
    row["tolerance"] = claim.tolerance;
    row["error_kind"] = claim.relative ? "relative" : "absolute";
    row["error_against"] = r.error_against;
    row["levels"] = Json::array();
    for (std::size_t k = 0; k < r.runs.size(); ++k) {
      const StudyRun& run = *r.runs[k];
      row["levels"].push_back({{"resolution", run.spacing},
                               {"setting", setting_json(setting_of(run, r.curve->key))},
                               {"value", number(r.values[k].value)},
                               {"error", number(r.errors[k])},
                               {"pass", r.values[k].pass},
                               {"pareto", static_cast<bool>(r.worth[k])},
                               {"wall_s", run.record.wall_s},
                               {"forecast_wall_s", number(run.record.forecast_wall_s)},
                               {"particles", run.record.particles},
                               {"acoustic_steps", run.record.acoustic_steps},
                               {"memory_peak_bytes", run.record.memory_bytes},
                               {"folder", run.folder}});
    }
    row["left_out"] = r.left_out;
    row["order"] = number(r.convergence.order);
    row["order_from"] = r.convergence.order_from;
    row["richardson"] = number(r.convergence.extrapolated);
    row["uncertainty"] = number(r.convergence.uncertainty);
    row["gci"] = number(r.convergence.gci);
    row["label"] = r.convergence.label;
    row["sentence"] = r.price;
    out["results"].push_back(std::move(row));
  }
  return out;
}

std::string render_study(const Study& study, const std::vector<StudyResult>& results) {
  std::string out;
  for (const StudyRun& run : study.runs)
    if (run.record.status != "done")
      out += fmt::format("{}: {}{}{}\n", printable(settings_text(run.settings)), run.record.status,
                         run.record.message.empty() ? "" : ": ", printable(run.record.message));
  for (const StudyResult& r : results) {
    const StudyClaim& claim = claim_of(study, r.name);
    out += fmt::format("\n{}", printable(r.name));
    if (r.reference()) out += fmt::format(", reference {:.6g}", *r.reference());
    if (claim.tolerance > 0)
      out += fmt::format(", tolerance {}", error_cell(claim.tolerance, claim.relative));
    if (!r.curve->others.empty()) out += ", " + printable(settings_text(r.curve->others));
    if (!r.error_against.empty()) out += "; errors against " + r.error_against;
    out += fmt::format(
        "\n  {:>14}  {:>9}  {:>11}  {:>10}  {:>5}  {:>11}  {:>11}  {:>10}  {:>9}  {:>9}\n",
        shortened(printable(r.curve->key), 14), "dp [m]", "value", "error", "", "wall time",
        "forecast", "particles", "steps", "memory");
    for (std::size_t k = 0; k < r.runs.size(); ++k) {
      const StudyRun& run = *r.runs[k];
      const RunOutcome& record = run.record;
      out += fmt::format(
          "  {:>14}  {:>9.4g}  {:>11}  {:>10}  {:>5}  {:>11}  {:>11}  {:>10}  {:>9}  {:>9}{}\n",
          shortened(printable(setting_of(run, r.curve->key)), 14), run.spacing,
          cell(r.values[k].value), error_cell(r.errors[k], claim.relative),
          r.values[k].pass ? "pass" : "FAIL", seconds_text(record.wall_s),
          record.forecast_wall_s ? seconds_text(*record.forecast_wall_s) : "-", record.particles,
          record.acoustic_steps, bytes_text(record.memory_bytes), r.worth[k] ? "  *" : "");
    }
    for (const std::string& run : r.left_out) out += "  left out: " + printable(run) + "\n";
    if (r.by_spacing) out += "  " + convergence_text(r.convergence) + "\n";
    out += "  " + r.price + "\n";
  }
  if (!results.empty()) out += "\n* no other run of this result is as accurate and as fast\n";
  return out;
}

}  // namespace sphgeo
