// The top of a report: how the runs ended, and their key figures.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/cost_figures.h"
#include "report/markup.h"
#include "report/page_parts.h"

namespace sphgeo {

using Json = nlohmann::ordered_json;

namespace {

enum class As { count, number, seconds, bytes };

std::string written(double value, As as) {
  switch (as) {
    case As::count:
      return count_text(value);
    case As::seconds:
      return wall_text(value);
    case As::bytes:
      return bytes_text(value);
    default:
      return number_text(value);
  }
}

/// The number at a place of a run's summary, or "–".
std::string at(Runs runs, std::size_t k, const std::string& path, As as,
               std::string_view unit = {}) {
  const std::optional<double> value = number_at(runs[k].summary, path);
  if (!value) return "–";
  return traced(written(*value, as) + (unit.empty() ? "" : "\u00a0" + std::string(unit)), path, k);
}

/// ", forecast 3.8 s" below a figure.
std::string forecast(Runs runs, std::size_t k, const std::string& key, As as) {
  const std::string path = "/forecast/" + key;
  return number_at(runs[k].summary, path) ? "forecast " + at(runs, k, path, as) : "";
}

struct Fact {
  std::string label, html;
};

std::vector<Fact> facts_of(Runs runs, std::size_t k) {
  const Json& s = runs[k].summary;
  std::vector<Fact> facts;
  if (const Json& sets = value_at(s, "/particles"); sets.is_object() && !sets.empty()) {
    double sum = 0;
    std::string each;
    for (const auto& [set, count] : sets.items()) {
      if (!count.is_number()) continue;
      sum += count.get<double>();
      each += (each.empty() ? "" : ", ") + html_escaped(set) + "\u00a0" +
              at(runs, k, "/particles/" + pointer_part(set), As::count);
    }
    facts.push_back({"Particles", count_text(sum) + small_text(each)});
  }
  const bool relaxation = is_relaxation(runs[k]);
  if (relaxation)
    facts.push_back({"Relaxation steps", at(runs, k, "/relaxation/steps", As::count)});
  if (!relaxation) {
    const double solid = number_at(s, "/steps/solid").value_or(0);
    facts.push_back(
        {"Simulated time",
         at(runs, k, "/time_s", As::number, "s") +
             (runs[k].model
                  ? small_text("of " + html_escaped(number_text(runs[k].model->end_time)) +
                               "\u00a0s")
                  : "")});
    facts.push_back(
        {"Acoustic steps",
         at(runs, k, "/steps/acoustic", As::count) +
             small_text(
                 "in " + at(runs, k, "/steps/advection", As::count) + " advection steps" +
                 (solid > 0 ? ", " + at(runs, k, "/steps/solid", As::count) + " of solids" : ""))});
  }
  const double threads = number_at(s, "/threads").value_or(1);
  facts.push_back({"Wall time", at(runs, k, "/wall_s", As::seconds) +
                                    small_text(forecast(runs, k, "wall_s", As::seconds)) +
                                    small_text(at(runs, k, "/threads", As::count) +
                                               (threads == 1 ? " thread" : " threads"))});
  facts.push_back({"Peak memory", at(runs, k, "/memory_peak_bytes", As::bytes) +
                                      small_text(forecast(runs, k, "memory_bytes", As::bytes))});
  if (!relaxation)
    facts.push_back({"On disk", at(runs, k, "/forecast/actual/disk_bytes", As::bytes) +
                                    small_text(forecast(runs, k, "disk_bytes", As::bytes))});
  if (const auto speed = number_at(s, "/particle_updates_per_s_per_core"); speed && *speed > 0)
    facts.push_back({"Speed", fmt::format("{:.3g}\u00a0million", *speed / 1e6) +
                                  small_text("particle updates per second and core")});
  return facts;
}

/// "4 of 5 expectations met" as a badge.
std::string expect_badge(const RunRecord& run) {
  const Json& expect = value_at(run.summary, "/expect");
  if (!expect.is_array() || expect.empty()) return {};
  const auto met = std::count_if(expect.begin(), expect.end(),
                                 [](const Json& e) { return value_at(e, "/pass") == true; });
  const bool all = static_cast<std::size_t>(met) == expect.size();
  if (text_at(run.summary, "/status") != "done") return {};  // measured too early
  return fmt::format("<span class=\"badge {}\">{} of {} expectation{} met</span>",
                     all ? "good" : "bad", met, expect.size(), expect.size() == 1 ? "" : "s");
}

std::string status_badge(const RunRecord& run) {
  const std::string status = text_at(run.summary, "/status");
  return fmt::format("<span class=\"badge {}\">{}</span>",
                     status == "done"                        ? "good"
                     : status == "stopped" || status.empty() ? "warn"
                                                             : "bad",
                     status.empty() ? "not finished" : html_escaped(status));
}

/// What the guard reports about the failure of a run.
std::string guard_sentence(const Json& guard) {
  std::string out;
  const auto add = [&](std::string_view label, const std::string& text) {
    if (!text.empty())
      out += (out.empty() ? "" : " · ") + std::string(label) + " <strong>" + html_escaped(text) +
             "</strong>";
  };
  add("cause", text_at(guard, "/cause"));
  add("effect", text_at(guard, "/effect"));
  add("set", text_at(guard, "/set"));
  if (const auto p = number_at(guard, "/particle")) add("particle", fmt::format("{:.0f}", *p));
  if (const Json& position = value_at(guard, "/position");
      position.is_array() && position.size() == 3)
    add("at", fmt::format("({}, {}, {}) m", number_text(number_at(position, "/0").value_or(NAN)),
                          number_text(number_at(position, "/1").value_or(NAN)),
                          number_text(number_at(position, "/2").value_or(NAN))));
  if (const auto t = number_at(guard, "/time_s")) add("t =", number_text(*t, 6) + " s");
  return out;
}

std::string messages(const RunRecord& run, bool several) {
  std::string out;
  const std::string who = several ? "<strong>" + html_escaped(run.label) + "</strong>: " : "";
  const bool soft = text_at(run.summary, "/status") == "stopped";
  if (const std::string message = text_at(run.summary, "/message"); !message.empty()) {
    const std::string guard = value_at(run.summary, "/guard/tripped") == true
                                  ? guard_sentence(value_at(run.summary, "/guard"))
                                  : "";
    out += fmt::format("<div class=\"message{}\"><p>{}{}{}</p>{}</div>\n", soft ? " warn" : "", who,
                       soft ? "stopped early: " : "", html_escaped(message),
                       guard.empty() ? "" : "<p><small>" + guard + "</small></p>");
  }
  for (const std::string& problem : run.problems)
    out +=
        fmt::format("<div class=\"message warn\"><p>{}{}</p></div>\n", who, html_escaped(problem));
  return out;
}

}  // namespace

std::string header_html(Runs runs) {
  std::string out;
  for (const RunRecord& run : runs) {
    const Json& s = run.summary;
    std::string about;
    const auto add = [&](const std::string& text) {
      about += (about.empty() || text.empty() ? "" : " · ") + html_escaped(text);
    };
    add(text_at(s, "/deck"));
    if (const auto dimension = number_at(s, "/dimension")) add(fmt::format("{:.0f}D", *dimension));
    if (run.model) add(fmt::format("spacing {} m", number_text(run.model->resolution)));
    if (const std::string version = text_at(s, "/version"); !version.empty())
      add("sphgeo " + version);
    if (const std::string hash = text_at(s, "/deck_hash"); !hash.empty()) add("deck hash " + hash);
    out += fmt::format("<div class=\"status\">{}{}{}<span class=\"quiet\">{}</span></div>\n",
                       runs.size() > 1 ? "<strong>" + html_escaped(run.label) + "</strong>" : "",
                       status_badge(run), expect_badge(run), about);
  }
  for (const RunRecord& run : runs) out += messages(run, runs.size() > 1);
  return out;
}

std::string figures_html(Runs runs) {
  if (runs.size() == 1) {
    std::string out = "<dl class=\"facts\">\n";
    for (const Fact& f : facts_of(runs, 0))
      out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", f.label, f.html);
    return out + "</dl>\n";
  }
  std::vector<std::vector<Fact>> facts;
  std::vector<std::string> labels;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    facts.push_back(facts_of(runs, k));
    for (const Fact& f : facts.back())
      if (std::find(labels.begin(), labels.end(), f.label) == labels.end())
        labels.push_back(f.label);
  }
  std::string rows;
  for (const std::string& label : labels) {
    rows += "<tr>" + cell(label);
    for (const auto& of_run : facts) {
      const auto it = std::find_if(of_run.begin(), of_run.end(),
                                   [&](const Fact& f) { return f.label == label; });
      rows += cell(it == of_run.end() ? "–" : it->html, "run");
    }
    rows += "</tr>\n";
  }
  return table("", run_heads(runs, 1, 1), rows);
}

}  // namespace sphgeo
