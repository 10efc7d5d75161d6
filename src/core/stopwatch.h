#pragma once
// Time that parts of a run take: on the clock, and of the processors.

#include <chrono>
#include <ctime>

namespace sphgeo {

/// Wall time since `start`, s.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Processor time of all threads of the program so far, s. A thread that waits for a loop or for
/// its end looks for it for some ten microseconds before it sleeps; that counts as well.
inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// What a part of a run has taken so far.
struct Spent {
  double seconds = 0;    ///< on the clock
  double processor = 0;  ///< of all threads together, s
};

/// Adds to `spent` what its scope takes.
class Stopwatch {
 public:
  explicit Stopwatch(Spent& spent) : spent_(spent) {}
  ~Stopwatch() {
    spent_.processor += processor_seconds() - processor_;
    spent_.seconds += seconds_since(start_);
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Spent& spent_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double processor_ = processor_seconds();
};

}  // namespace sphgeo
