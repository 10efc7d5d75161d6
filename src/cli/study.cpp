#include "study/study.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>

#include "cli/child_runs.h"
#include "cli/commands.h"
#include "cli/stop_requests.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/text.h"
#include "core/version.h"
#include "deck/model.h"
#include "output/progress.h"
#include "output/run_folder.h"

namespace sphgeo {
namespace {

std::string today() {
  const std::time_t now = std::time(nullptr);
  return fmt::format("{:%Y-%m-%d}", fmt::localtime(now));
}

/// "AMD EPYC 7B13, 2 threads".
std::string machine_name() {
  std::string name = "unknown processor";
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      name = std::string(trimmed(line.substr(line.find(':') + 1)));
      break;
    }
  return fmt::format("{}, {} threads", printable(name),
                     std::max(1u, std::thread::hardware_concurrency()));
}

/// The first line of a log with an error, else the last line.
std::string complaint_in(const std::string& log) {
  std::ifstream file(log);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    if (line.find("error") != std::string::npos) return line;
    if (!trimmed(line).empty()) last = line;
  }
  return last;
}

/// All inputs of a run except the program: the deck, with probes and end time, and the
/// files that it names. A run is used again only if it would be the same.
std::string what_decides(const Model& model) {
  const std::string deck = resolved_yaml(model);
  std::string all = deck;
  std::istringstream lines(deck);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(": ");
    if (at == std::string::npos) continue;
    std::string value = line.substr(at + 2);
    if (value.size() > 1 && (value.front() == '"' || value.front() == '\'') &&
        value.back() == value.front())
      value = value.substr(1, value.size() - 2);
    std::error_code none;
    if (!value.empty() && value.front() == '/' && std::filesystem::is_regular_file(value, none))
      all += fmt::format("{:016x}", fnv1a(read_file(value)));
  }
  return all;
}

/// The command of one study.
class StudyCommand {
 public:
  explicit StudyCommand(const StudyOptions& options) : options_(options) {}

  int operator()() {
    design();
    const FolderLock lock(options_.folder);
    std::filesystem::create_directories(options_.folder + "/runs");
    StopRequests requests(options_.folder + "/stop", {options_.max_hours, {}, {}});
    queue_missing();
    tell(fmt::format("{} run{}, {} to do\n", study_.runs.size(), study_.runs.size() == 1 ? "" : "s",
                     children_.size()));
    const auto wall = [this] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    };
    const std::string stopped = run_children(
        children_, options_.jobs, [&] { return requests.reason(wall(), 0, {}, 0); },
        [&](std::size_t k) {
          if (!options_.max_hours) return;
          const double left = std::max(1e-6, *options_.max_hours - wall() / 3600);
          children_[k].arguments.insert(children_[k].arguments.end(),
                                        {"--max-hours", fmt::format("{:.9f}", left)});
        },
        [&](std::size_t k) { ended(k); });
    write(stopped, wall());
    if (!stopped.empty() || stopped_runs_ > 0) {
      std::cerr << fmt::format("stopped: {}; the same command continues the study\n",
                               printable(stopped.empty() ? "a run was stopped" : stopped));
      return static_cast<int>(ExitCode::stopped);
    }
    return worst_;
  }

 private:
  void tell(const std::string& text) const {
    if (!options_.quiet) std::cerr << text;
  }

  /// Reads the deck once with the settings of each run: all mistakes come before the first run
  /// starts.
  void design() {
    if (options_.vary.empty())
      throw Error(ExitCode::usage, "a study needs --vary KEY=VALUE,VALUE...");
    if (options_.deck == "-")
      throw Error(ExitCode::usage, "a study reads its deck once for each run: give it as a file");
    for (const std::string& text : options_.vary) {
      study_.varied.push_back(parse_variation(text));
      for (std::size_t k = 0; k + 1 < study_.varied.size(); ++k)
        if (study_.varied[k].key == study_.varied.back().key)
          throw Error(ExitCode::usage,
                      "--vary '" + printable(study_.varied.back().key) + "' is given twice");
    }
    study_.design =
        options_.combine ? all_combinations(study_.varied) : one_at_a_time(study_.varied);
    study_.deck = options_.deck;
    study_.date = today();
    study_.machine = machine_name();
    study_.version = version();
    for (const std::vector<Setting>& settings : study_.design.runs) {
      const Model model = read_deck(options_.deck, overrides(settings));
      if (study_.runs.empty()) {
        study_.title = model.title;
        for (const Expect& e : model.expect) {
          const bool curve = e.reduce == "curve", within = e.measure == "within";
          study_.claims.push_back({e.name, curve || (within && e.tolerance_kind == "relative"),
                                   e.measure == "above" ? 0 : e.tolerance,
                                   curve || e.measure == "below"});
        }
        if (study_.claims.empty())
          throw Error(ExitCode::usage,
                      printable(options_.deck) +
                          " claims nothing under 'expect': there is no result to study");
      }
      const std::string hash = fmt::format("{:016x}", fnv1a(what_decides(model))).substr(0, 8);
      std::string name = settings_text(settings);
      std::replace(name.begin(), name.end(), '=', '_');
      std::replace(name.begin(), name.end(), ' ', '-');
      study_.runs.push_back({settings,
                             model.resolution,
                             "runs/" + shortened(file_name_of(name), 100) + "-" + hash,
                             {}});
    }
  }

  std::vector<std::string> overrides(const std::vector<Setting>& settings) const {
    std::vector<std::string> all = options_.set;
    for (const auto& [key, value] : settings) all.push_back(key + "=" + value);
    return all;
  }

  std::string folder_of(std::size_t run) const {
    return options_.folder + "/" + study_.runs[run].folder;
  }

  void queue_missing() {
    // The short runs first: their results are available while the long ones run.
    std::vector<std::size_t> order(study_.runs.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return study_.runs[a].spacing > study_.runs[b].spacing;
    });
    for (const std::size_t k : order) {
      StudyRun& run = study_.runs[k];
      run.record = read_outcome(folder_of(k));
      if (run.record.status == "done" || run.record.status == "unstable") {
        tell(fmt::format("  {}: used again, {}\n", printable(settings_text(run.settings)),
                         run.record.status));
        if (run.record.status == "unstable") worst_ = static_cast<int>(ExitCode::unstable);
        continue;
      }
      ChildRun child;
      child.arguments = {"run", options_.deck, "-o", folder_of(k), "--resume", "--quiet"};
      for (const std::string& text : overrides(run.settings))
        child.arguments.insert(child.arguments.end(), {"--set", text});
      const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
      const int threads = options_.threads > 0 ? options_.threads
                          : options_.jobs > 1  ? std::max(1, cores / options_.jobs)
                                               : 0;
      if (threads > 0)
        child.arguments.insert(child.arguments.end(), {"--threads", std::to_string(threads)});
      child.log = folder_of(k) + ".log";
      children_.push_back(std::move(child));
      queued_.push_back(k);
    }
  }

  void ended(std::size_t child) {
    StudyRun& run = study_.runs[queued_[child]];
    const int code = children_[child].exit_code;
    run.record = read_outcome(folder_of(queued_[child]));
    std::string what = fmt::format("{} in {}", run.record.status, duration_text(run.record.wall_s));
    if (code == static_cast<int>(ExitCode::stopped)) {
      ++stopped_runs_;
    } else if (code != 0) {
      worst_ = std::max(worst_, code < 0 ? static_cast<int>(ExitCode::internal) : code);
      if (run.record.status == "missing") run.record.status = "failed";
      if (run.record.message.empty()) run.record.message = complaint_in(children_[child].log);
      what = run.record.status + ": " + run.record.message;
    }
    tell(fmt::format("  {}: {}\n", printable(settings_text(run.settings)), printable(what)));
    write_json();  // the results so far are kept if a later run fails
  }

  void write_json() const {
    const auto json = to_json(study_, study_results(study_));
    write_file_atomically(
        options_.folder + "/study.json",
        json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
  }

  void write(const std::string& stopped, double wall_s) const {
    write_json();
    const bool unfinished = !stopped.empty() || stopped_runs_ > 0;
    const nlohmann::ordered_json summary = {
        {"status", unfinished    ? "stopped"
                   : worst_ == 0 ? "done"
                                 : "failed"},
        {"exit_code", unfinished ? static_cast<int>(ExitCode::stopped) : worst_},
        {"version", study_.version},
        {"title", study_.title},
        {"deck", study_.deck},
        {"runs", study_.runs.size()},
        {"wall_s", wall_s}};
    write_file_atomically(
        options_.folder + "/summary.json",
        summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
    write_file_atomically(options_.folder + "/study.html",
                          study_page(study_, study_results(study_)));
    std::cout << render_study(study_, study_results(study_));
  }

  const StudyOptions& options_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Study study_;
  std::vector<ChildRun> children_;
  std::vector<std::size_t> queued_;  ///< the run that each child does
  int stopped_runs_ = 0;
  int worst_ = 0;
};

}  // namespace

int study_command(const StudyOptions& options) { return StudyCommand(options)(); }

}  // namespace sphgeo
