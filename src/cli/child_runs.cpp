#include "cli/child_runs.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <map>
#include <thread>

#include "core/atomic_file.h"

extern char** environ;

namespace sphgeo {
namespace {

pid_t start(const ChildRun& run) {
  constexpr const char* program = "/proc/self/exe";
  std::vector<std::string> words = {"sphgeo"};
  words.insert(words.end(), run.arguments.begin(), run.arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, run.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  // A group of its own: Ctrl-C at the terminal reaches it once, as the SIGTERM sent here, not
  // twice.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t pid = -1;
  const int problem = posix_spawn(&pid, program, &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) throw_io_error(run.log, "cannot start a run that writes here", problem);
  return pid;
}

void end(ChildRun& run, int status) {
  run.finished = true;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::string run_children(std::vector<ChildRun>& runs, int jobs,
                         const std::function<std::string()>& stop_reason,
                         const std::function<void(std::size_t)>& before,
                         const std::function<void(std::size_t)>& ready) {
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0;
  std::string stopped;
  const auto stop_all = [&] {
    for (const auto& [pid, k] : running) ::kill(pid, SIGTERM);
  };
  try {
    while (!running.empty() || (next < runs.size() && stopped.empty())) {
      if (stopped.empty()) {
        stopped = stop_reason();
        if (!stopped.empty()) stop_all();
      }
      if (stopped.empty() && next < runs.size() &&
          running.size() < static_cast<std::size_t>(jobs)) {
        before(next);
        running.emplace(start(runs[next]), next);
        ++next;
        continue;
      }
      bool ended = false;
      for (auto at = running.begin(); at != running.end();) {
        int status = 0;
        const pid_t got = ::waitpid(at->first, &status, WNOHANG);
        if (got == 0 || (got < 0 && errno == EINTR)) {
          ++at;
          continue;
        }
        const std::size_t k = at->second;
        at = running.erase(at);
        end(runs[k], got < 0 ? -1 : status);
        ready(k);
        ended = true;
      }
      if (!ended) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  } catch (...) {  // runs end with their study
    stop_all();
    for (const auto& [pid, k] : running) ::waitpid(pid, nullptr, 0);
    throw;
  }
  return stopped;
}

}  // namespace sphgeo
