#include "report/run_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "core/atomic_file.h"
#include "core/error.h"
#include "output/run_folder.h"

namespace sphgeo {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// Larger files are not shown.
constexpr std::uint64_t most_text = 64 << 20;  // bytes

TimeSeries read_series(const std::string& name, const std::string& path) {
  const CsvTable table = read_csv_table(path);
  TimeSeries series;
  series.name = name;
  for (const std::string& heading : table.names()) {
    const auto bracket = heading.ends_with(']') ? heading.rfind(" [") : std::string::npos;
    NamedColumn column{heading.substr(0, bracket),
                       bracket == std::string::npos
                           ? ""
                           : heading.substr(bracket + 2, heading.size() - bracket - 3),
                       table.numbers(heading)};
    if (&heading == &table.names().front()) series.time = std::move(column.values);
    else series.columns.push_back(std::move(column));
  }
  return series;
}

/// Calls `read`; an error becomes a sentence of the record.
template <class F>
void attempt(RunRecord& record, const F& read) {
  try {
    read();
  } catch (const DeckError& e) {
    record.problems.push_back(
        fmt::format("resolved.yaml cannot be read by this version: {}",
                    e.diagnostics.items().empty() ? "" : e.diagnostics.items().front().message));
  } catch (const std::exception& e) {
    record.problems.emplace_back(e.what());
  }
}

void read_probes(RunRecord& record) {
  const std::string folder = record.folder + "/probes";
  std::vector<std::pair<std::string, std::string>> files;  // name, path
  if (record.model) {
    files.emplace_back(relaxation_probe, folder + "/" + relaxation_probe + ".csv");
    for (const auto& p : record.model->probes)
      files.emplace_back(p->name, folder + "/" + file_name_of(p->name) + ".csv");
  } else {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
      if (entry.path().extension() == ".csv")
        files.emplace_back(entry.path().stem().string(), entry.path().string());
    std::sort(files.begin(), files.end());
  }
  for (const auto& [name, path] : files)
    if (fs::exists(path))
      attempt(record, [&, &probe = name, &file = path] {
        record.probes.push_back(read_series(probe, file));
      });
}

void read_frames(RunRecord& record) {
  const fs::path folder = fs::path(record.folder) / "frames";
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".pvd") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files)
    attempt(record, [&] {
      std::vector<PvdFile::Frame> frames = PvdFile::read(file.string()).frames();
      for (PvdFile::Frame& f : frames) f.file = (folder / f.file).string();
      if (!frames.empty()) record.frames[file.stem().string()] = std::move(frames);
    });
}

}  // namespace

const NamedColumn* TimeSeries::find(std::string_view column) const {
  const auto it = std::find_if(columns.begin(), columns.end(),
                               [&](const NamedColumn& c) { return c.name == column; });
  return it == columns.end() ? nullptr : &*it;
}

const TimeSeries* RunRecord::series(const std::string& probe) const {
  if (probe == "run") return run ? &*run : nullptr;
  const auto it = std::find_if(probes.begin(), probes.end(),
                               [&](const TimeSeries& s) { return s.name == probe; });
  return it == probes.end() ? nullptr : &*it;
}

RunRecord read_run(const std::string& folder) {
  RunRecord record;
  record.folder = folder;
  record.label = fs::path(folder).lexically_normal().filename().string();
  if (record.label.empty() || record.label == ".")
    record.label = fs::absolute(folder).lexically_normal().parent_path().filename().string();
  record.summary = Json::object();
  const std::string deck = folder + "/resolved.yaml", summary = folder + "/summary.json",
                    rows = folder + "/run.csv";
  if (!fs::exists(deck) && !fs::exists(summary))
    throw IoError(folder, "is not a run folder: it has neither summary.json nor resolved.yaml");
  if (fs::exists(summary)) {
    attempt(record, [&] {
      Json read = Json::parse(read_file(summary, most_text));
      if (read.is_object()) record.summary = std::move(read);
      else throw IoError(summary, "is not a summary of a run");
    });
  } else {
    record.problems.emplace_back("there is no summary.json: the run is in progress, or was killed");
  }
  if (fs::exists(deck)) {
    attempt(record, [&] { record.deck = read_file(deck, most_text); });
    attempt(record, [&] { record.model = read_deck(deck); });
  }
  if (fs::exists(rows)) attempt(record, [&] { record.run = read_series("run", rows); });
  read_probes(record);
  read_frames(record);
  return record;
}

std::vector<RunRecord> read_runs(const std::vector<std::string>& folders) {
  std::vector<RunRecord> records;
  for (const std::string& folder : folders) records.push_back(read_run(folder));
  const auto same = [&](const RunRecord& a) {
    return std::count_if(records.begin(), records.end(),
                         [&](const RunRecord& b) { return b.label == a.label; }) > 1;
  };
  std::vector<std::string> labels;
  for (const RunRecord& r : records) labels.push_back(same(r) ? r.folder : r.label);
  for (std::size_t i = 0; i < records.size(); ++i) records[i].label = labels[i];
  return records;
}

bool is_relaxation(const RunRecord& run) {
  return value_at(run.summary, "/relaxation").is_object();
}

const Json& value_at(const Json& json, const std::string& pointer) {
  static const Json none;
  try {
    return json.at(Json::json_pointer(pointer));
  } catch (const Json::exception&) {
    return none;
  }
}

std::optional<double> number_at(const Json& json, const std::string& pointer) {
  const Json& value = value_at(json, pointer);
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

std::string text_at(const Json& json, const std::string& pointer) {
  const Json& value = value_at(json, pointer);
  return value.is_string() ? value.get<std::string>() : "";
}

}  // namespace sphgeo
