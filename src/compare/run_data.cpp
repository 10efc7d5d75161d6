// The data of a run from its folder.

#include "compare/run_data.h"

#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "output/vtu_reader.h"
#include "report/run_record.h"

namespace sphgeo {

namespace {

using Json = nlohmann::ordered_json;

Error refusal(const std::string& path, const std::string& why) {
  return Error(ExitCode::usage, path + ": " + why);
}

/// A number or a list of numbers; null stands for what is not finite.
std::vector<double> numbers(const Json& j) {
  const auto one = [](const Json& x) { return x.is_number() ? x.get<double>() : std::nan(""); };
  if (!j.is_array()) return {one(j)};
  std::vector<double> out;
  for (const Json& x : j) out.push_back(one(x));
  return out;
}

SetState last_frame(const std::string& set_name, const VtuFrame& frame) {
  SetState set;
  set.set = set_name;
  set.particles = static_cast<Index>(frame.points.size());
  set.positions = frame.points;
  for (const VtuColumn& field : frame.point_fields) {
    if (field.name == "id") continue;
    const auto n = static_cast<std::size_t>(field.components);
    for (std::size_t c = 0; c < n; ++c) {
      const std::string part = n == 1   ? ""
                               : n == 3 ? std::string(".") + "xyz"[c]
                                        : "." + std::to_string(c);
      FieldState one{field.name + part, {}};
      for (std::size_t k = 0; k < field.tuples(); ++k)
        one.values.push_back(field.values[k * n + c]);
      set.fields.push_back(std::move(one));
    }
  }
  return set;
}

void take_summary(const Json& summary, RunData& run) {
  run.title = text_at(summary, "/title");
  run.status = text_at(summary, "/status");
  run.version = text_at(summary, "/version");
  run.time = number_at(summary, "/time_s").value_or(0);
  for (const auto& [name, count] : value_at(summary, "/steps").items())
    if (count.is_number()) run.steps.emplace_back(name, count.get<double>());
  for (const auto& [name, row] : value_at(summary, "/ledger").items())
    if (row.is_object() && row.contains("initial") && row.contains("final"))
      run.ledger.emplace_back(name, LedgerState{numbers(row["initial"]), numbers(row["final"])});
  for (const Json& row : value_at(summary, "/expect")) {
    if (!row.is_object()) continue;
    const Json& pass = value_at(row, "/pass");
    run.results.emplace_back(
        text_at(row, "/name"),
        ResultState{number_at(row, "/value"), number_at(row, "/tolerance").value_or(0),
                    pass.is_boolean() && pass.get<bool>()});
  }
}

}  // namespace

RunData read_run_data(const std::string& folder) {
  const RunRecord record = read_run(folder);
  if (!record.problems.empty()) throw refusal(folder, record.problems.front());
  if (text_at(record.summary, "/status").empty())
    throw refusal(folder, "there is no summary.json: this run has not ended");
  RunData run;
  run.path = folder;
  run.resolution = record.model ? record.model->resolution : 0;
  take_summary(record.summary, run);
  for (const TimeSeries& probe : record.probes)
    for (const NamedColumn& column : probe.columns)
      run.probes.push_back({probe.name, column.name, column.unit, probe.time, column.values});
  for (const auto& [set, frames] : record.frames) {
    if (frames.empty()) continue;
    const VtuFrame frame = read_vtu(frames.back().file);
    // Surfaces of boundaries are geometry of the deck.
    if (frame.corners_per_cell == 1) run.sets.push_back(last_frame(set, frame));
  }
  return run;
}

RunData read_either(const std::string& path) {
  return std::filesystem::is_directory(path) ? read_run_data(path) : read_baseline(path);
}

}  // namespace sphgeo
