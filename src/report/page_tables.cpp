// The sections of a report that are tables: claims, ledger, guard, time, plan; and the deck.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "output/cost_figures.h"
#include "report/markup.h"
#include "report/page_parts.h"

namespace sphgeo {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t most_rows = 400;      ///< of one table
constexpr std::size_t most_deck = 250'000;  ///< bytes of a deck's text, over all runs

/// The deck's definition of a claim.
const Expect* claim(const RunRecord& run, const std::string& name) {
  if (!run.model) return nullptr;
  const auto it = std::find_if(run.model->expect.begin(), run.model->expect.end(),
                               [&](const Expect& e) { return e.name == name; });
  return it == run.model->expect.end() ? nullptr : &*it;
}

std::string how_judged(const Expect* e) {
  if (!e) return {};
  if (e->measure == "above") return "at least";
  if (e->measure == "below") return "at most";
  if (e->reduce == "curve") return e->norm == "relative_l2" ? "relative" : "of the range";
  return e->tolerance_kind == "relative" ? "relative" : "absolute";
}

std::string what_measured(const Expect* e) {
  if (!e) return {};
  std::string out =
      e->reduce == "curve"
          ? (e->norm == "max" ? "largest difference of the curve of "
                              : "mean difference of the curve of ")
          : html_escaped(e->reduce) + (e->at ? " " + number_text(*e->at) + "\u00a0s" : "") + " of ";
  out += "<code>" + html_escaped(e->probe) + "</code>";
  if (e->from || e->to)
    out += fmt::format(", {} to {}", e->from ? number_text(*e->from) + "\u00a0s" : "start",
                       e->to ? number_text(*e->to) + "\u00a0s" : "end");
  return out;
}

std::string result_cell(const Json& e, bool several) {
  const bool pass = value_at(e, "/pass") == true;
  return cell(pass ? "<span class=\"good\">pass</span>"
                   : "<span class=\"bad\"><strong>fail</strong></span>",
              several ? "run" : "");
}

std::optional<std::size_t> index_of(const Json& list, const std::string& name) {
  for (std::size_t i = 0; list.is_array() && i < list.size(); ++i)
    if (text_at(list[i], "/name") == name) return i;
  return {};
}

/// The names in one list of all runs ("/expect", "/effects"), in the order in which they first
/// come.
std::vector<std::string> names_in(Runs runs, const std::string& path) {
  std::vector<std::string> names;
  for (const RunRecord& run : runs)
    for (const Json& entry : value_at(run.summary, path))
      if (const std::string name = text_at(entry, "/name");
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  if (names.size() > most_rows) names.resize(most_rows);
  return names;
}

std::string vector_text(const Json& value) {
  if (value.is_number()) return number_text(value.get<double>(), 6);
  std::string out;
  if (value.is_array())
    for (const Json& part : value)
      out +=
          (out.empty() ? "" : ", ") + number_text(part.is_number() ? part.get<double>() : NAN, 4);
  return out.empty() ? "–" : value.is_array() ? "(" + out + ")" : out;
}

}  // namespace

std::string expect_html(Runs runs) {
  const std::vector<std::string> names = names_in(runs, "/expect");
  if (names.empty()) return {};
  const bool several = runs.size() > 1;
  std::string head = run_heads(runs, 1, 3, 2) + "<tr>" + head_cell("claim");
  const std::string own = head_cell("result", several ? "run" : "") + head_cell("value", "n") +
                          (several ? "" : head_cell("reference", "n")) + head_cell("error", "n");
  for (std::size_t k = 0; k < runs.size(); ++k)
    head += own + (several ? "" : head_cell("tolerance", "n"));
  if (several) head += head_cell("reference", "n run") + head_cell("tolerance", "n");
  head += "</tr>";
  std::string rows;
  for (const std::string& name : names) {
    std::string row, notes, reference, tolerance;
    const Expect* said = nullptr;
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const auto i = index_of(value_at(runs[k].summary, "/expect"), name);
      if (!i) {
        row += "<td class=\"run\" colspan=\"3\">–</td>";
        continue;
      }
      if (!said) said = claim(runs[k], name);
      const std::string path = fmt::format("/expect/{}", *i);
      const Json& e = value_at(runs[k].summary, path);
      const auto number = [&](const char* key) {
        return number_cell(number_at(e, std::string("/") + key), path + "/" + key, k, 5);
      };
      if (reference.empty()) {
        reference = number("reference");
        const auto t = number_at(e, "/tolerance");
        tolerance = cell((t ? traced(number_text(*t), path + "/tolerance", k) : "–") +
                             small_text(how_judged(claim(runs[k], name))),
                         "n");
      }
      row += result_cell(e, several) + number("value") + (several ? "" : reference) +
             number("error") + (several ? "" : tolerance);
      if (const std::string note = text_at(e, "/note"); !note.empty())
        notes += small_text("<span class=\"warn\">" +
                            (several ? html_escaped(runs[k].label) + ": " : "") +
                            html_escaped(note) + "</span>");
    }
    rows += "<tr>" +
            cell("<strong>" + html_escaped(name) + "</strong>" + small_text(what_measured(said)) +
                     (said ? small_text(html_escaped(said->source)) : "") + notes,
                 "wide") +
            row + (several ? reference + tolerance : "") + "</tr>\n";
  }
  const bool early = std::any_of(runs.begin(), runs.end(), [](const RunRecord& run) {
    return text_at(run.summary, "/status") != "done";
  });
  return (early ? "<p class=\"quiet\">Results of a run that did not reach its end are those up to "
                  "its last time.</p>\n"
                : "") +
         table("", head, rows);
}

std::string time_html(Runs runs) {
  const std::vector<std::string> names = names_in(runs, "/effects");
  if (names.empty()) return {};
  const bool several = runs.size() > 1;
  std::string head = run_heads(runs, 1, 2) + "<tr>" + head_cell("effect");
  for (std::size_t k = 0; k < runs.size(); ++k)
    head += (several ? "" : head_cell("calls", "n")) +
            head_cell("seconds", several ? "n run" : "n") + head_cell("share", "n") +
            (several ? "" : head_cell("busy", "n"));
  head += several ? "</tr>" : "<th></th></tr>";
  std::string rows;
  for (const std::string& name : names) {
    rows += "<tr>" + cell(html_escaped(name));
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const auto i = index_of(value_at(runs[k].summary, "/effects"), name);
      const std::string path = fmt::format("/effects/{}", i.value_or(0));
      const auto value = [&](const char* key) {
        return i ? number_at(runs[k].summary, path + "/" + key) : std::nullopt;
      };
      const auto calls = value("calls"), seconds = value("seconds"), share = value("share");
      if (!several)
        rows += cell(calls ? count_text(*calls) : "–", "n", calls ? path + "/calls" : "", k);
      rows += cell(seconds ? number_text(*seconds, 3) : "–", several ? "n run" : "n",
                   seconds ? path + "/seconds" : "", k);
      rows += cell(share ? fmt::format("{:.1f}\u00a0%", 100 * *share) : "–", "n");
      if (const auto busy = value("busy"); !several)
        rows += cell(busy ? fmt::format("{:.1f}\u00a0%", 100 * *busy) : "–", "n",
                     busy ? path + "/busy" : "", k);
      if (!several)
        rows += cell(fmt::format("<span class=\"bar\" style=\"width:{:.1f}%\"></span>",
                                 100 * std::clamp(share.value_or(0), 0.0, 1.0)),
                     "bar-cell");
    }
    rows += "</tr>\n";
  }
  return table(several ? "slim" : "", head, rows);
}

std::string ledger_html(Runs runs) {
  std::string out;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const Json& ledger = value_at(runs[k].summary, "/ledger");
    if (!ledger.is_object() || ledger.empty()) continue;
    std::string rows;
    for (const auto& [name, row] : ledger.items()) {
      const std::string unit = text_at(row, "/unit"), path = "/ledger/" + pointer_part(name);
      const auto value = [&](const char* key) {
        const Json& number = value_at(row, std::string("/") + key);
        return cell(vector_text(number), "n", number.is_number() ? path + "/" + key : "", k);
      };
      std::string label = name;
      std::replace(label.begin(), label.end(), '_', ' ');
      rows += "<tr>" + cell(html_escaped(label)) + value("initial") + value("final") +
              cell(html_escaped(unit_text(unit))) +
              number_cell(number_at(row, "/relative_error"), path + "/relative_error", k, 3) +
              "</tr>\n";
    }
    out += (runs.size() > 1 ? "<h3>" + html_escaped(runs[k].label) + "</h3>\n" : "") +
           table("slim",
                 "<tr>" + head_cell("quantity") + head_cell("start", "n") + head_cell("end", "n") +
                     head_cell("unit") + head_cell("change, relative", "n") + "</tr>",
                 rows);
  }
  return out;
}

std::string guard_html(Runs runs) {
  std::vector<std::string> names;
  for (const RunRecord& run : runs)
    for (const auto& [name, value] : value_at(run.summary, "/guard").items())
      if (value.is_number() && name != "particle" && name != "time_s" &&
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  if (names.empty()) return {};
  std::string rows;
  for (const std::string& name : names) {
    std::string label = name;
    std::replace(label.begin(), label.end(), '_', ' ');
    rows += "<tr>" + cell(html_escaped(label));
    for (std::size_t k = 0; k < runs.size(); ++k)
      rows += number_cell(number_at(runs[k].summary, "/guard/" + pointer_part(name)),
                          "/guard/" + pointer_part(name), k);
    rows += "</tr>\n";
  }
  std::string head = "<tr>" + head_cell("extreme over the run");
  for (const RunRecord& run : runs)
    head += head_cell(runs.size() > 1 ? html_escaped(run.label) : "value", "n");
  return "<h3>Quantities watched by the guard</h3>\n" + table("slim", head + "</tr>", rows);
}

std::string plan_html(Runs runs) {
  std::string out;
  for (const RunRecord& run : runs) {
    const Json& plan = value_at(run.summary, "/plan");
    if (!plan.is_array() || plan.empty()) continue;
    std::string rows, last;
    std::size_t count = 0;
    for (const Json& e : plan) {
      if (++count > most_rows) break;
      const std::string stage = text_at(e, "/stage");
      rows += "<tr>" + cell(stage == last ? "" : html_escaped(stage)) +
              cell("<code>" + html_escaped(text_at(e, "/name")) + "</code>") +
              cell(html_escaped(text_at(e, "/equations"))) +
              cell(html_escaped(text_at(e, "/acts_on"))) +
              cell(html_escaped(text_at(e, "/because")), "wide") + "</tr>\n";
      last = stage;
    }
    out += fmt::format(
        "<details><summary>{}{} effects, in the order in which they ran</summary>\n{}</details>\n",
        runs.size() > 1 ? html_escaped(run.label) + ": " : "", plan.size(),
        table("",
              "<tr>" + head_cell("stage") + head_cell("effect") + head_cell("equations") +
                  head_cell("acts on") + head_cell("because") + "</tr>",
              rows));
  }
  return out;
}

std::string deck_html(Runs runs) {
  std::string out;
  const std::size_t most = most_deck / runs.size();
  for (const RunRecord& run : runs) {
    if (run.deck.empty()) continue;
    const bool cut = run.deck.size() > most;
    out += fmt::format(
        "<details><summary>{}resolved.yaml, the deck with every "
        "default</summary>\n{}<pre>{}</pre></details>\n",
        runs.size() > 1 ? html_escaped(run.label) + ": " : "",
        cut ? fmt::format("<p class=\"quiet\">The first {} of {}; the file in the run folder is "
                          "complete.</p>\n",
                          bytes_text(static_cast<double>(most)),
                          bytes_text(static_cast<double>(run.deck.size())))
            : "",
        html_escaped(shortened(run.deck, most)));
  }
  return out;
}

}  // namespace sphgeo
