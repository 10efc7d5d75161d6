#pragma once
// The contents of a run folder, for pages about runs.

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/csv_table.h"
#include "deck/model.h"
#include "output/pvd.h"

namespace sphgeo {

/// A column of a table, with the unit apart from the name.
struct NamedColumn {
  std::string name, unit;
  std::vector<double> values;
};

/// A table over time: of a probe, or run.csv.
struct TimeSeries {
  std::string name;
  std::vector<double> time;  ///< s
  std::vector<NamedColumn> columns;

  /// nullptr when there is none of that name.
  const NamedColumn* find(std::string_view column) const;
};

/// The results in one run folder. What is missing or damaged is named in `problems`; the rest is
/// there.
struct RunRecord {
  std::string folder;
  std::string label;               ///< short, and different for each of several runs
  nlohmann::ordered_json summary;  ///< an object, empty when there is none
  std::string deck;                ///< the text of resolved.yaml
  std::optional<Model> model;      ///< the same as values
  std::optional<TimeSeries> run;   ///< run.csv
  std::vector<TimeSeries> probes;  ///< in the order of the deck
  std::map<std::string, std::vector<PvdFile::Frame>>
      frames;  ///< by set, in order of time; with full paths
  std::vector<std::string> problems;

  /// The probe of that name, "run" for run.csv; nullptr when there is none.
  const TimeSeries* series(const std::string& probe) const;
};

/// Reads a run folder. Throws IoError when there is neither a summary.json nor a resolved.yaml in
/// it.
RunRecord read_run(const std::string& folder);

/// Reads several and gives them labels that differ.
std::vector<RunRecord> read_runs(const std::vector<std::string>& folders);

/// Whether `sphgeo relax` made it: its times are the numbers of its steps.
bool is_relaxation(const RunRecord& run);

/// What stands at "/steps/advection", as a number; empty when it is missing, null or something
/// else.
std::optional<double> number_at(const nlohmann::ordered_json& json, const std::string& pointer);
/// The same as text; "" when it is missing or something else.
std::string text_at(const nlohmann::ordered_json& json, const std::string& pointer);
/// What stands there, or null.
const nlohmann::ordered_json& value_at(const nlohmann::ordered_json& json,
                                       const std::string& pointer);

}  // namespace sphgeo
