#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "compare/difference.h"
#include "core/error.h"
#include "core/text.h"

namespace sphgeo {

int compare_command(const CompareOptions& options) {
  const RunData run = read_run_data(options.run);
  if (options.update) {
    if (std::filesystem::is_directory(options.baseline))
      throw Error(ExitCode::usage,
                  printable(options.baseline) + ": --update writes a file, and this is a folder");
    if (run.status != "done")
      throw Error(ExitCode::usage, printable(options.run) + ": a run that is '" +
                                       printable(run.status) + "' is not a baseline");
    write_baseline(options.baseline, run);
    std::cerr << fmt::format("{}: written from {}\n", printable(options.baseline),
                             printable(options.run));
    return 0;
  }
  const RunData baseline = read_either(options.baseline);
  const Tolerances tolerances =
      options.tolerances.empty() ? Tolerances{} : read_tolerances(options.tolerances);
  const std::vector<RunDifference> differences = compare_runs(run, baseline, tolerances);
  const auto failed = std::count_if(differences.begin(), differences.end(),
                                    [](const RunDifference& d) { return !d.pass; });
  if (options.json) {
    const nlohmann::ordered_json out = {{"run", options.run},
                                        {"baseline", options.baseline},
                                        {"pass", failed == 0},
                                        {"differences", to_json(differences)}};
    std::cout << out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
  } else {
    std::cout << render_differences(differences,
                                    options.all ? std::numeric_limits<std::size_t>::max() : 3);
    std::cout << fmt::format("{} of {} compared are within tolerance\n",
                             static_cast<std::ptrdiff_t>(differences.size()) - failed,
                             differences.size());
  }
  return static_cast<int>(failed == 0 ? ExitCode::done : ExitCode::mismatch);
}

}  // namespace sphgeo
