// sphgeo: soil, water, rock and structures with smoothed particle hydrodynamics, from a YAML deck.

#include <fcntl.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <system_error>

#include "cli/commands.h"
#include "core/error.h"
#include "core/text.h"
#include "output/progress.h"

namespace {

using namespace sphgeo;

/// "; did you mean 'run'?", or nothing.
std::string offer(const std::string& word, const std::vector<std::string>& names) {
  const std::string near = nearest_name(word, names);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// "DECK", "-o DIR": a required option as the user writes it.
std::string as_written(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (option.get_positional()) return type;
  const std::string flag =
      option.get_snames().empty() ? option.get_name() : "-" + option.get_snames().front();
  return flag + " " + type;
}

/// What is wrong with the command line, as one sentence; the most helpful finding first.
std::string complaint(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const std::vector<std::string> own_rest = app.remaining();
  if (chosen.empty()) {
    if (own_rest.empty()) return "a command is missing";
    const std::string& word = own_rest.front();
    if (word.front() == '-')
      return "there is no option '" + word + "'" + offer(word, option_names(app));
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands(nullptr)) names.push_back(sub->get_name());
    return "there is no command '" + word + "'" + offer(word, names);
  }
  const CLI::App& sub = *chosen.front();
  const std::string name = "'sphgeo " + sub.get_name() + "'";
  std::vector<std::string> rest = sub.remaining();
  rest.insert(rest.end(), own_rest.begin(), own_rest.end());
  for (const std::string& word : rest)
    if (word.size() > 1 && word.front() == '-') {
      const std::string flag = word.substr(0, word.find('='));
      return name + " has no option '" + flag + "'" + offer(flag, option_names(sub));
    }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
    for (const CLI::Option* option : sub.get_options())
      if (option->get_required() && option->count() == 0)
        return name + " needs " + as_written(*option) + ", " + option->get_description();
  if (!rest.empty()) return name + " has no use for '" + rest.front() + "'";
  return error.what();
}

int usage_error(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
  const auto chosen = app.get_subcommands();
  std::cerr << "error: " << printable(complaint(app, error), "\n") << "\n";
  if (chosen.empty()) std::cerr << "  'sphgeo --help' lists the commands\n";
  else std::cerr << "  'sphgeo " << chosen.front()->get_name() << " --help' lists its options\n";
  return static_cast<int>(ExitCode::usage);
}

/// A number above 0 of type T; the text is what the error calls it.
template <class T>
CLI::Validator above_zero(const std::string& what) {
  return CLI::Validator(
      [what](const std::string& text) {
        T value{};
        const char* end = text.data() + text.size();
        const auto [stop, problem] = std::from_chars(text.data(), end, value);
        return problem == std::errc{} && stop == end && value > 0 && value < T(1e9)
                   ? ""
                   : "'" + text + "' is not " + what + " above 0";
      },
      "", "above zero");
}

/// More than any machine has; each takes memory and an entry of the system's table.
constexpr int most_threads = 1024;

/// A number of threads that can be asked for.
CLI::Validator thread_count() {
  return CLI::Validator(
      [](const std::string& text) {
        double n = 0;
        const char* end = text.data() + text.size();
        const auto [stop, problem] = std::from_chars(text.data(), end, n);
        if (problem != std::errc{} || stop != end || !(n >= 1) || n != std::floor(n))
          return "'" + text + "' is not a whole number above 0";
        return n <= most_threads ? "" : fmt::format("'{}': at most {} threads", text, most_threads);
      },
      "", "threads");
}

int lost_output(int error_number) {
  std::cerr << "error: cannot write to standard output: " << std::strerror(error_number) << "\n";
  return static_cast<int>(ExitCode::io);
}

int run_guarded(const std::function<int()>& command) {
  try {
    return command();
  } catch (const DeckError& e) {
    std::cerr << e.diagnostics.render(progress_style_of_stderr().color);
    return static_cast<int>(e.code());
  } catch (const Error& e) {
    std::cerr << "error: " << printable(e.what(), "\n") << "\n";
    return static_cast<int>(e.code());
  } catch (const std::bad_alloc&) {
    std::cerr << "error: there is not enough memory for this scene\n";
    return static_cast<int>(ExitCode::internal);
  } catch (const std::system_error& e) {
    if (std::ferror(stdout) != 0) return lost_output(e.code().value());
    std::cerr << "internal error: " << printable(e.what(), "\n") << "\n";
    return static_cast<int>(ExitCode::internal);
  } catch (const std::exception& e) {
    std::cerr << "internal error: " << printable(e.what(), "\n") << "\n";
    return static_cast<int>(ExitCode::internal);
  }
}

void add_deck(CLI::App* app, std::string& deck, std::vector<std::string>& set) {
  app->add_option("deck", deck, "the deck to read (- for standard input)")
      ->required()
      ->type_name("DECK");
  app->add_option("--set", set, "change a key: a.b[0].c=value; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
}

/// A standard stream that the caller has closed would lend its number to the next file that is
/// opened, and messages would go into it. Opened the wrong way round, such a stream refuses what is
/// written.
void keep_standard_streams() {
  for (const int stream : {0, 1, 2})
    if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY) < 0)
      return;
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_streams();
  // Whoever reads our output may go away; that must not end a run.
  std::signal(SIGPIPE, SIG_IGN);
  // A limit on the size of files is an error of writing, as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{
      "soil, water, rock and structures with smoothed particle hydrodynamics, from a YAML deck",
      "sphgeo"};
  app.set_version_flag(
      "--version",
      [] {
        std::string text = version_text();
        text.pop_back();  // the line ends by itself
        return text;
      },
      "print version, commit, compiler, vector width and libraries");
  app.require_subcommand(1);
  const auto whole = above_zero<int>("a whole number");
  int code = 0;

  RunOptions run;
  CLI::App* run_app = app.add_subcommand("run", "run a deck");
  add_deck(run_app, run.deck, run.set);
  run_app->add_option("-o,--output", run.folder, "the folder of the results")
      ->required()
      ->type_name("DIR");
  run_app
      ->add_option("--threads", run.threads, "number of threads (default: what the scene can use)")
      ->check(thread_count())
      ->type_name("N");
  CLI::Option* overwrite =
      run_app->add_flag("--overwrite", run.overwrite, "replace the results in the folder");
  run_app
      ->add_flag("--resume", run.resume,
                 "continue from the checkpoint in the folder, if there is one")
      ->excludes(overwrite);
  run_app
      ->add_option("--max-hours", run.limits.max_hours,
                   "stop, resumable, before this wall time is over")
      ->check(above_zero<double>("a number"))
      ->type_name("H");
  run_app
      ->add_option("--max-steps", run.limits.max_steps, "stop, resumable, after N advection steps")
      ->check(whole)
      ->type_name("N");
  run_app
      ->add_option("--max-acoustic-steps", run.limits.max_acoustic_steps,
                   "the same after N acoustic steps, also within an advection step")
      ->check(whole)
      ->type_name("N");
  run_app->add_flag("--verify", run.verify, "exit with 4 when a result under 'expect' is not met");
  run_app->add_flag_callback(
      "--no-report", [&] { run.report = false; }, "do not write report.html at the end");
  run_app->add_flag("-q,--quiet", run.quiet, "no progress and no time table");
  run_app->callback([&] { code = run_guarded([&] { return run_command(run); }); });

  CheckOptions check;
  CLI::App* check_app = app.add_subcommand("check", "check a deck without running it");
  add_deck(check_app, check.deck, check.set);
  check_app->add_flag("--explain", check.explain,
                      "print the plan: effects and why they run, lists, fields, memory");
  check_app->add_flag("--json", check.json, "the plan and the forecast as JSON");
  check_app->add_option("--preview", check.preview, "draw the scene at t = 0 into this PNG")
      ->type_name("FILE");
  check_app->add_flag_callback(
      "--no-calibrate", [&] { check.calibrate = false; },
      "do not time a few steps: no forecast of the time");
  check_app->add_option("--threads", check.threads, "number of threads of the forecast run")
      ->check(thread_count())
      ->type_name("N");
  check_app->callback([&] { code = run_guarded([&] { return check_command(check); }); });

  RelaxOptions relax;
  CLI::App* relax_app =
      app.add_subcommand("relax", "distribute the water in the pores of soil, and store it");
  add_deck(relax_app, relax.deck, relax.set);
  relax_app->add_option("-o,--output", relax.folder, "the folder of the results")
      ->required()
      ->type_name("DIR");
  relax_app->add_option("--threads", relax.threads, "number of threads (default: all)")
      ->check(thread_count())
      ->type_name("N");
  relax_app->add_flag("--overwrite", relax.overwrite, "replace the results in the folder");
  relax_app->add_flag("--verify", relax.verify,
                      "exit with 4 when a result about the relaxation under 'expect' is not met");
  relax_app->add_flag("-q,--quiet", relax.quiet, "print only results");
  relax_app->callback([&] { code = run_guarded([&] { return relax_command(relax); }); });

  ExportOptions exported;
  CLI::App* export_app =
      app.add_subcommand("export", "write the surface of a body or a wall as STL");
  add_deck(export_app, exported.deck, exported.set);
  export_app->add_option("name", exported.name, "the body or the wall")
      ->required()
      ->type_name("NAME");
  export_app->add_option("-o,--output", exported.output, "the file")->required()->type_name("FILE");
  export_app->add_flag("--overwrite", exported.overwrite, "replace the file if it exists");
  export_app
      ->add_option("--spacing", exported.spacing,
                   "spacing of the grid that finds the surface, m (default: half the resolution)")
      ->type_name("S");
  export_app->callback([&] { code = run_guarded([&] { return export_command(exported); }); });

  StudyOptions study;
  CLI::App* study_app =
      app.add_subcommand("study", "run a deck with different settings: accuracy against time");
  add_deck(study_app, study.deck, study.set);
  study_app
      ->add_option(
          "--vary", study.vary,
          "the values that a key takes in turn, as resolution=0.04,0.02,0.01; may be repeated")
      ->required()
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE,VALUE...");
  study_app->add_flag("--combine", study.combine,
                      "run all combinations of the varied keys (default: one key at a time)");
  study_app
      ->add_option("-o,--output", study.folder,
                   "the folder of the study; runs in it are used again")
      ->required()
      ->type_name("DIR");
  study_app
      ->add_option("--jobs", study.jobs, "runs at the same time; more than one disturbs the times")
      ->check(whole)
      ->type_name("N");
  study_app->add_option("--threads", study.threads, "number of threads of each run")
      ->check(thread_count())
      ->type_name("N");
  study_app
      ->add_option("--max-hours", study.max_hours, "stop, resumable, before this wall time is over")
      ->check(above_zero<double>("a number"))
      ->type_name("H");
  study_app->add_flag("-q,--quiet", study.quiet, "print only results");
  study_app->callback([&] { code = run_guarded([&] { return study_command(study); }); });

  CompareOptions compare;
  CLI::App* compare_app =
      app.add_subcommand("compare", "compare a run with another run or with a baseline");
  compare_app->add_option("run", compare.run, "the folder of the run")
      ->required()
      ->type_name("RUN");
  compare_app
      ->add_option("baseline", compare.baseline,
                   "a run folder, or a file that --update has written")
      ->required()
      ->type_name("BASELINE");
  compare_app->add_option("--tolerances", compare.tolerances, "a YAML file of tolerances")
      ->type_name("FILE");
  CLI::Option* update = compare_app->add_flag("--update", compare.update,
                                              "write the run to the file as its new baseline");
  compare_app->add_flag("--json", compare.json, "print JSON")->excludes(update);
  compare_app->add_flag("--all", compare.all, "list all that was compared")->excludes(update);
  compare_app->callback([&] { code = run_guarded([&] { return compare_command(compare); }); });
  ReportOptions report;
  CLI::App* report_app =
      app.add_subcommand("report", "write a page about one run, or several side by side");
  report_app->add_option("runs", report.runs, "the folders of the runs")
      ->required()
      ->type_name("RUN...");
  report_app
      ->add_option("-o,--output", report.output,
                   "the page (default: report.html in the folder of the run)")
      ->type_name("FILE");
  report_app->callback([&] { code = run_guarded([&] { return report_command(report); }); });

  CLI::App* list_app =
      app.add_subcommand("list", "print all types, deck sections, effects and fields");
  list_app->callback([&] { code = run_guarded(list_command); });

  std::string type;
  CLI::App* show_app = app.add_subcommand(
      "show", "print the keys of a type or section, or describe an effect or field");
  show_app->add_option("type", type, "a name that 'sphgeo list' prints")
      ->required()
      ->type_name("TYPE");
  show_app->callback([&] { code = run_guarded([&] { return show_command(type); }); });

  CLI::App* reference_app =
      app.add_subcommand("reference", "print the reference of all keys and types as Markdown");
  reference_app->callback([&] { code = run_guarded(reference_command); });

  CLI::App* schema_app = app.add_subcommand("schema", "print the JSON Schema of decks");
  schema_app->callback([&] { code = run_guarded(schema_command); });

  BenchOptions bench;
  CLI::App* bench_app =
      app.add_subcommand("bench", "measure the speed of the pair loops on fixed scenes");
  bench_app->add_flag("--json", bench.json, "print JSON");
  bench_app->add_flag("--effects", bench.effects,
                      "measure the cost of effects that a scene does not need");
  bench_app->add_option("--scene", bench.scenes, "only this scene; may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME");
  bench_app->add_option("--size", bench.sizes, "particles (default: 20000 150000 1000000)")
      ->check(whole)
      ->type_name("N");
  bench_app
      ->add_option("--precision", bench.precision,
                   "precision of the pair sums: single, double or both")
      ->check(CLI::IsMember({"single", "double", "both"}))
      ->type_name("WORD");
  bench_app->add_option("--seconds", bench.seconds, "seconds of measuring in each repeat")
      ->check(above_zero<double>("a number"))
      ->type_name("S");
  bench_app->add_option("--repeats", bench.repeats, "number of repeats; the best is reported")
      ->check(whole)
      ->type_name("N");
  bench_app->callback([&] { code = run_guarded([&] { return bench_command(bench); }); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return usage_error(app, e);
  }
  std::cout.flush();
  if (const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
      (lost || !std::cout) && code == 0)
    return lost_output(errno);
  return code;
}
