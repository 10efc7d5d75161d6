#include "cli/stop_requests.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <csignal>
#include <utility>

#include "core/unfinished_files.h"

namespace sphgeo {
namespace {

// A signal handler can only access variables of static storage.
volatile std::sig_atomic_t signals_seen = 0;
volatile std::sig_atomic_t last_signal = 0;

void on_signal(int number) {
  last_signal = number;
  signals_seen = signals_seen + 1;
  if (signals_seen < 3) return;
  remove_unfinished_files();
  ::signal(number, SIG_DFL);
  ::raise(number);
}

void take_signals(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // a write in progress is not interrupted
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM}) ::sigaction(number, &action, nullptr);
  // A closed terminal stops a run in order, unless nohup is used.
  struct sigaction before {};
  if (::sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
    ::sigaction(SIGHUP, &action, nullptr);
}

}  // namespace

StopRequests::StopRequests(std::string stop_file, RunLimits limits)
    : stop_file_(std::move(stop_file)), limits_(limits) {
  ::unlink(stop_file_.c_str());
  signals_seen = 0;
  take_signals(on_signal);
}

StopRequests::~StopRequests() { take_signals(SIG_DFL); }

std::string StopRequests::reason(double wall_seconds, double reserve_seconds,
                                 std::optional<long> steps, long acoustic_steps) {
  if (signals_seen > 0)
    return last_signal == SIGINT   ? "interrupted (SIGINT)"
           : last_signal == SIGHUP ? "its terminal was closed (SIGHUP)"
                                   : "terminated (SIGTERM)";
  if (limits_.max_steps && steps && *steps >= *limits_.max_steps)
    return fmt::format("--max-steps {} reached", *limits_.max_steps);
  if (limits_.max_acoustic_steps && acoustic_steps >= *limits_.max_acoustic_steps)
    return fmt::format("--max-acoustic-steps {} reached", *limits_.max_acoustic_steps);
  // A margin of a hundredth for unmeasured times.
  if (limits_.max_hours && wall_seconds + reserve_seconds >= 0.99 * 3600 * *limits_.max_hours)
    return fmt::format("--max-hours {} reached", *limits_.max_hours);
  if (::access(stop_file_.c_str(), F_OK) == 0) {
    ::unlink(stop_file_.c_str());
    return "the file '" + stop_file_ + "' requests it";
  }
  return "";
}

}  // namespace sphgeo
