#include "core/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace sphgeo {
namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

/// The number that a file of the system begins with; none for "max" or a missing file.
std::optional<std::uint64_t> number_in(const std::string& path) {
  std::ifstream file(path);
  std::uint64_t n = 0;
  if (file >> n) return n;
  return std::nullopt;
}

/// Pages of the process in all and in main memory.
std::pair<std::uint64_t, std::uint64_t> pages() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return {all, resident};
}

std::uint64_t page_bytes() { return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)); }

/// MemAvailable of the machine: free memory and what caches would give up.
std::uint64_t machine_available() {
  std::ifstream file("/proc/meminfo");
  std::string key;
  std::uint64_t kilobytes = 0;
  for (std::string rest; file >> key >> kilobytes; std::getline(file, rest))
    if (key == "MemAvailable:") return kilobytes * 1024;
  return unlimited;
}

/// What the control groups from `group` up to the root of `tree` leave. What their caches hold
/// counts as used, so this is on the safe side.
std::uint64_t left_in_groups(const std::string& tree, std::string group, const char* limit_file,
                             const char* use_file) {
  std::uint64_t left = unlimited;
  for (;;) {
    const std::string folder = tree + group + "/";
    const auto limit = number_in(folder + limit_file), used = number_in(folder + use_file);
    if (limit && used) left = std::min(left, *limit > *used ? *limit - *used : 0);
    if (group.empty()) return left;
    group.erase(group.rfind('/'));
  }
}

std::uint64_t groups_available() {
  std::uint64_t left = unlimited;
  std::ifstream file("/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    // "number:controllers:/path"; the controllers of version 2 are empty.
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    std::string group = line.substr(second + 1);
    if (group.empty() || group.front() != '/') continue;
    if (group == "/") group.clear();
    if (controllers.empty())
      left =
          std::min(left, left_in_groups("/sys/fs/cgroup", group, "memory.max", "memory.current"));
    else if (controllers == "memory")
      left = std::min(left, left_in_groups("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes",
                                           "memory.usage_in_bytes"));
  }
  return left;
}

std::uint64_t address_space_available() {
  struct rlimit limit {};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const std::uint64_t used = pages().first * page_bytes();
  return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

}  // namespace

std::uint64_t resident_memory() { return pages().second * page_bytes(); }

std::uint64_t available_memory() {
  return std::min({machine_available(), groups_available(), address_space_available()});
}

}  // namespace sphgeo
