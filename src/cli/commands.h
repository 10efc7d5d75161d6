#pragma once
// The commands of the sphgeo binary. Each returns the exit code of the process.

#include <optional>
#include <string>
#include <vector>

#include "cli/stop_requests.h"

namespace sphgeo {

struct RunOptions {
  std::string deck;
  std::string folder;
  std::vector<std::string> set;
  int threads = 0;  ///< 0: chosen for the scene
  bool overwrite = false;
  bool resume = false;  ///< continue from the checkpoint in the folder, if there is one
  RunLimits limits;
  bool verify = false;  ///< exit 4 when an `expect` is not met
  bool quiet = false;
  bool report = true;  ///< write report.html at the end
};
int run_command(const RunOptions& options);

struct CheckOptions {
  std::string deck;
  std::vector<std::string> set;
  bool explain = false;
  bool json = false;
  std::string preview;    ///< a PNG of the scene; empty: none
  bool calibrate = true;  ///< time a few steps for the forecast
  int threads = 0;        ///< that the run would have; 0: chosen for the scene
};
int check_command(const CheckOptions& options);

struct ReportOptions {
  std::vector<std::string> runs;  ///< their folders
  std::string output;             ///< the page; empty: report.html in the folder of the only run
};
/// Writes a page about runs. Throws Error (usage) when several runs have no page named, IoError.
int report_command(const ReportOptions& options);

struct RelaxOptions {
  std::string deck;
  std::string folder;
  std::vector<std::string> set;
  int threads = 0;  ///< 0: all of the machine
  bool overwrite = false;
  bool verify = false;  ///< exit 4 when a claim about the relaxation is not met
  bool quiet = false;
};
/// Relaxes the water in soil and stores it. Throws Error (usage) when the deck has none.
int relax_command(const RelaxOptions& options);

struct ExportOptions {
  std::string deck;
  std::string name;    ///< of a body or a wall
  std::string output;  ///< an STL file
  std::vector<std::string> set;
  std::optional<double>
      spacing;             ///< of the grid that finds the surface, m; empty: half the resolution
  bool overwrite = false;  ///< whether the file may exist
};
/// Writes the surface of a body or a wall as binary STL. Throws Error (usage), DeckError, IoError.
int export_command(const ExportOptions& options);

struct StudyOptions {
  std::string deck;
  std::string folder;
  std::vector<std::string> set;
  std::vector<std::string> vary;  ///< KEY=VALUE,VALUE...
  bool combine = false;           ///< all combinations of the varied keys; else one key at a time
  int jobs = 1;                   ///< runs at the same time
  int threads = 0;                ///< of each run; 0: what the scene can use, shared among the jobs
  std::optional<double> max_hours;
  bool quiet = false;
};
/// Runs a deck with different settings and reports accuracy against time. Runs that are in the
/// folder already are used again. Throws Error (usage), DeckError, IoError.
int study_command(const StudyOptions& options);

struct CompareOptions {
  std::string run;
  std::string baseline;    ///< a run folder, or a file that --update has written
  std::string tolerances;  ///< a YAML file; empty: the defaults
  bool update = false;     ///< write the run as the baseline
  bool json = false;
  bool all = false;  ///< list all that was compared
};
/// Compares a run with another or with a baseline; exit 4 when one difference is above its
/// tolerance. Throws Error (usage), DeckError, IoError.
int compare_command(const CompareOptions& options);

struct BenchOptions {
  bool json = false;
  std::vector<std::string> scenes;  ///< empty: all
  std::vector<long> sizes;          ///< particles; empty: 20 000, 150 000, 1 000 000
  std::string precision = "both";   ///< single | double | both
  double seconds = 2;               ///< of measuring per repeat
  int repeats = 5;
  bool effects = false;  ///< cost of effects that the scenes do not need
};
int bench_command(const BenchOptions& options);
/// The part --effects of it.
int bench_effects_command(const BenchOptions& options);

int schema_command();

/// Prints the names of deck sections, types, effects and fields.
int list_command();
/// Describes everything of this name. Throws Error (usage) when there is none.
int show_command(const std::string& type);
/// Describes all of them as Markdown.
int reference_command();

/// The version of this build with commit, compiler, width of vectors, threads and libraries, as
/// lines.
std::string version_text();

}  // namespace sphgeo
