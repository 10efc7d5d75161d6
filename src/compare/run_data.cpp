// The data of a run from its folder.

#include "compare/run_data.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/csv_table.h"
#include "core/error.h"
#include "core/text.h"
#include "output/pvd.h"
#include "output/vtu_reader.h"

namespace sphgeo {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Error refusal(const std::string& path, const std::string& why) { return Error(ExitCode::usage, path + ": " + why); }

std::string text_in(const Json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->get<std::string>() : "";
}

double number_in(const Json& object, const char* key, double otherwise = 0) {
  const auto at = object.find(key);
  return at != object.end() && at->is_number() ? at->get<double>() : otherwise;
}

/// A number or a list of numbers; null stands for what is not finite.
std::vector<double> numbers(const Json& j) {
  const auto one = [](const Json& x) { return x.is_number() ? x.get<double>() : std::nan(""); };
  if (!j.is_array()) return {one(j)};
  std::vector<double> out;
  for (const Json& x : j) out.push_back(one(x));
  return out;
}

/// Names of the files with this ending in a folder, sorted: the order of a folder is the system's.
std::vector<fs::path> files_in(const std::string& folder, const std::string& ending) {
  std::vector<fs::path> out;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ending) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

void read_probes(const std::string& folder, RunData& run) {
  for (const fs::path& path : files_in(folder + "/probes", ".csv")) {
    const CsvTable table = read_csv_table(path.string());
    if (table.names().empty()) continue;
    const std::vector<double> t = table.numbers(table.names().front());
    for (std::size_t k = 1; k < table.names().size(); ++k) {
      const std::string& name = table.names()[k];
      const std::size_t bracket = name.find(" [");
      const std::string unit = bracket == std::string::npos ? "" : name.substr(bracket + 2, name.size() - bracket - 3);
      run.probes.push_back({path.stem().string(), name.substr(0, bracket), unit, t, table.numbers(name)});
    }
  }
}

void read_sets(const std::string& folder, RunData& run) {
  for (const fs::path& path : files_in(folder + "/frames", ".pvd")) {
    const PvdFile pvd = PvdFile::resume(path.string(), std::numeric_limits<double>::infinity());
    if (pvd.frames().empty()) continue;
    const VtuFrame frame = read_vtu((path.parent_path() / pvd.frames().back().file).string());
    if (frame.corners_per_cell != 1) continue;  // surfaces of boundaries: geometry of the deck
    SetState set;
    set.set = path.stem().string();
    set.particles = static_cast<Index>(frame.points.size());
    set.places = frame.points;
    for (const VtuColumn& field : frame.point_fields) {
      if (field.name == "id") continue;
      for (int c = 0; c < field.components; ++c) {
        const std::string part = field.components == 1 ? "" : field.components == 3 ? std::string(".") + "xyz"[c] : "." + std::to_string(c);
        FieldState one{field.name + part, {}};
        for (std::size_t k = 0; k < field.tuples(); ++k) one.values.push_back(field.values[k * static_cast<std::size_t>(field.components) + static_cast<std::size_t>(c)]);
        set.fields.push_back(std::move(one));
      }
    }
    run.sets.push_back(std::move(set));
  }
}

/// The spacing of a run, from its deck with all defaults filled in.
double resolution_of(const std::string& folder) {
  const std::string text = read_file(folder + "/resolved.yaml");
  const std::size_t at = text.find("\nresolution:");
  return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + 12, nullptr);
}

}  // namespace

RunData read_run(const std::string& folder) {
  RunData run;
  run.path = folder;
  const std::string path = folder + "/summary.json";
  if (!fs::exists(path)) throw refusal(folder, "there is no summary.json: this is no run, or one that has not ended");
  const Json summary = Json::parse(read_file(path), nullptr, false);
  if (!summary.is_object() || text_in(summary, "status").empty()) throw refusal(path, "this is not a summary of a run");
  run.title = text_in(summary, "title");
  run.status = text_in(summary, "status");
  run.version = text_in(summary, "version");
  run.time = number_in(summary, "time_s");
  run.resolution = resolution_of(folder);
  if (summary.contains("steps") && summary["steps"].is_object())
    for (const auto& [name, count] : summary["steps"].items())
      if (count.is_number()) run.steps.emplace_back(name, count.get<double>());
  if (summary.contains("ledger") && summary["ledger"].is_object())
    for (const auto& [name, row] : summary["ledger"].items())
      if (row.is_object() && row.contains("initial") && row.contains("final"))
        run.ledger.emplace_back(name, LedgerState{numbers(row["initial"]), numbers(row["final"])});
  if (summary.contains("expect") && summary["expect"].is_array())
    for (const Json& row : summary["expect"]) {
      if (!row.is_object()) continue;
      ResultState result;
      if (row.contains("value") && row["value"].is_number()) result.value = row["value"].get<double>();
      result.tolerance = number_in(row, "tolerance");
      result.pass = row.value("pass", false);
      run.results.emplace_back(text_in(row, "name"), result);
    }
  read_probes(folder, run);
  read_sets(folder, run);
  return run;
}

RunData read_either(const std::string& path) { return fs::is_directory(path) ? read_run(path) : read_baseline(path); }

}  // namespace sphgeo
