#pragma once
// Runs of decks in separate processes, several at a time.

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace sphgeo {

/// A command of this program to run.
struct ChildRun {
  std::vector<std::string> arguments;  ///< after the program's name: "run", "deck.yaml", ...
  std::string log;                     ///< file for its output
  int exit_code = -1;                  ///< -1: never started or killed by a signal
  bool finished = false;
};

/// Starts the runs in order, `jobs` at a time. `stop_reason` is asked ten times a second: once it
/// gives a reason, the running ones get SIGTERM (they keep a checkpoint), no more are started, and
/// the reason is returned; else "". `ready` is called with each run that has ended, `before` just
/// before one starts. Throws IoError when a process or log cannot be made.
std::string run_children(std::vector<ChildRun>& runs, int jobs,
                         const std::function<std::string()>& stop_reason,
                         const std::function<void(std::size_t)>& before,
                         const std::function<void(std::size_t)>& ready);

}  // namespace sphgeo
