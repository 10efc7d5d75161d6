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
  explicit Stopwatch(Spent& spent) : Stopwatch(spent, true) {}
  /// For a part that runs for the n-th time. To ask for the processor time takes half a
  /// microsecond, twenty times as long as for that of the clock: of parts so short that this would
  /// count, every 16th call is asked, and stands for the others.
  Stopwatch(Spent& spent, long n)
      : Stopwatch(spent, n % 16 == 0 || spent.seconds > long_enough * static_cast<double>(n)) {}
  ~Stopwatch() {
    const double processor = asks_ ? processor_seconds() - processor_ : 0;
    const double seconds = seconds_since(start_);
    spent_.processor += asks_                ? processor
                        : spent_.seconds > 0 ? seconds * spent_.processor / spent_.seconds
                                             : seconds;
    spent_.seconds += seconds;
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Stopwatch(Spent& spent, bool asks)
      : spent_(spent), asks_(asks), processor_(asks ? processor_seconds() : 0) {}

  static constexpr double long_enough = 1e-4;  // mean of a call, s

  Spent& spent_;
  bool asks_;
  double processor_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace sphgeo
