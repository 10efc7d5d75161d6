#include <fmt/format.h>

#include <iostream>

#include "cli/commands.h"
#include "core/error.h"
#include "core/text.h"
#include "output/cost_figures.h"
#include "output/run_folder.h"
#include "report/page.h"

namespace sphgeo {

int report_command(const ReportOptions& options) {
  if (options.output.empty() && options.runs.size() > 1)
    throw Error(ExitCode::usage, "several runs share one report: name its file with -o FILE");
  const std::string path =
      options.output.empty() ? options.runs.front() + "/report.html" : options.output;
  const std::size_t bytes = write_report(options.runs, path);
  std::cerr << fmt::format("{}: {}\n", printable(path), bytes_text(static_cast<double>(bytes)));
  return static_cast<int>(ExitCode::done);
}

}  // namespace sphgeo
