// sphgeo: soil, water, rock and structures with smoothed particle hydrodynamics, from a YAML deck.

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "cli/commands.h"
#include "core/error.h"
#include "core/text.h"
#include "output/progress.h"

namespace {

using namespace sphgeo;

/// Command line errors of CLI11 as one sentence with the nearest valid name; exit code 2.
int usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
  std::cerr << "error: " << error.what() << "\n";
  if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands(nullptr)) names.push_back(sub->get_name());
    const std::string near = nearest_name(argv[1], names);
    if (!near.empty()) std::cerr << "  did you mean '" << near << "'?\n";
  }
  std::cerr << "  'sphgeo --help' lists the commands\n";
  return static_cast<int>(ExitCode::usage);
}

int run_guarded(const std::function<int()>& command) {
  try {
    return command();
  } catch (const DeckError& e) {
    std::cerr << e.diagnostics.render(progress_style_of_stderr().color);
    return static_cast<int>(e.code());
  } catch (const Error& e) {
    std::cerr << "error: " << e.what() << "\n";
    return static_cast<int>(e.code());
  } catch (const std::exception& e) {
    std::cerr << "internal error: " << e.what() << "\n";
    return static_cast<int>(ExitCode::internal);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"soil, water, rock and structures with smoothed particle hydrodynamics, from a YAML deck"};
  app.set_version_flag("--version", std::string("sphgeo ") + version());
  app.require_subcommand(1);
  int code = 0;

  RunOptions run;
  CLI::App* run_app = app.add_subcommand("run", "run a deck");
  run_app->add_option("deck", run.deck, "the deck (- for standard input)")->required();
  run_app->add_option("-o,--output", run.folder, "folder of the results")->required();
  run_app->add_option("--set", run.set, "override a key: a.b[0].c=value")->allow_extra_args(false);
  run_app->add_option("--threads", run.threads, "threads (default: what the scene can use)")->check(CLI::PositiveNumber);
  run_app->add_flag("--overwrite", run.overwrite, "replace the results in the folder");
  run_app->add_flag("--verify", run.verify, "exit with 4 when a result under 'expect' is not met");
  run_app->add_flag("-q,--quiet", run.quiet, "no progress and no time table");
  run_app->callback([&] { code = run_guarded([&] { return run_command(run); }); });

  CheckOptions check;
  CLI::App* check_app = app.add_subcommand("check", "check a deck without running it");
  check_app->add_option("deck", check.deck, "the deck (- for standard input)")->required();
  check_app->add_option("--set", check.set, "override a key: a.b[0].c=value")->allow_extra_args(false);
  check_app->add_flag("--explain", check.explain, "print the plan: what runs and why, lists, fields, memory");
  check_app->add_flag("--json", check.json, "the same as JSON");
  check_app->callback([&] { code = run_guarded([&] { return check_command(check); }); });

  CLI::App* schema_app = app.add_subcommand("schema", "print the JSON Schema of decks");
  schema_app->callback([&] { code = run_guarded(schema_command); });

  BenchOptions bench;
  CLI::App* bench_app = app.add_subcommand("bench", "measure the speed of the pair loops on fixed scenes");
  bench_app->add_flag("--json", bench.json, "print JSON");
  bench_app->add_option("--scene", bench.scenes, "only these scenes")->allow_extra_args(false);
  bench_app->add_option("--size", bench.sizes, "particles (default: 20000 150000 1000000)")->check(CLI::PositiveNumber);
  bench_app->add_option("--precision", bench.precision, "of the pair sums")->check(CLI::IsMember({"single", "double", "both"}));
  bench_app->add_option("--seconds", bench.seconds, "of measuring in each repeat")->check(CLI::PositiveNumber);
  bench_app->add_option("--repeats", bench.repeats, "repeats; the best counts")->check(CLI::PositiveNumber);
  bench_app->callback([&] { code = run_guarded([&] { return bench_command(bench); }); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return usage_error(app, e, argc, argv);
  }
  return code;
}
