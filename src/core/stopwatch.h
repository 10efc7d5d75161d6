#pragma once
// Time that parts of a run take: on the clock, and of the processors.

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <optional>
#include <string>
#include <thread>

#include "core/parallel.h"
#include "core/state_io.h"

namespace sphgeo {

/// Wall time since `start`, s.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Processor time of all threads of the program so far, s. Other threads than the one that asks are
/// known to some milliseconds only: good for a whole run, not for its parts.
inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The time that what follows takes on a machine with nothing else to do: the processor time
/// outside of loops, and that of loops divided among the threads. Counts loops as long as it lives.
class QuietWatch {
 public:
  double seconds() const {
    const double shared = shared_processor_seconds() - shared_;
    // More threads than processors take turns.
    const double at_once =
        std::clamp<double>(threads(), 1, std::max(1u, std::thread::hardware_concurrency()));
    return std::max(0.0, loop_processor_seconds() - processor_ - shared * (1 - 1 / at_once));
  }

 private:
  CountedLoops counted_;
  double processor_ = loop_processor_seconds(), shared_ = shared_processor_seconds();
};

/// What a part of a run has taken so far.
struct Spent {
  double seconds = 0;    ///< on the clock
  double processor = 0;  ///< of the thread of the run and of all others in its loops, s
  double latest = 0;     ///< of it that of the latest call that was asked, s
  double offered = 0;    ///< by all threads that the run had meanwhile, s

  /// Share of the threads' time in which they worked; 0 where no time passed.
  double busy() const { return offered > 0 ? processor / offered : 0; }
  Spent& operator+=(const Spent& other) {
    seconds += other.seconds;
    processor += other.processor;
    offered += other.offered;
    return *this;
  }
};

/// What a run has spent is part of its state: a resumed run goes on counting, with another number
/// of threads perhaps.
inline void put_spent(StateSink& sink, const std::string& name, const Spent& spent) {
  sink.put(name + "_seconds", std::array{spent.seconds, spent.processor, spent.offered});
}
inline Spent spent_of(const StateSource& source, const std::string& name) {
  std::array<double, 3> v{};
  source.get(name + "_seconds", std::span<double>(v));
  return {.seconds = v[0], .processor = v[1], .offered = v[2]};
}

/// Adds to `spent` what its scope takes.
class Stopwatch {
 public:
  explicit Stopwatch(Spent& spent) : Stopwatch(spent, true) {}
  /// For a part that runs for the n-th time. To ask for the processor time takes a microsecond,
  /// fifty times as long as for that of the clock: of parts so short that this would count, every
  /// 16th call is asked, and stands for the others.
  Stopwatch(Spent& spent, long n)
      : Stopwatch(spent, n % 16 == 0 || spent.seconds > long_enough * static_cast<double>(n)) {}
  ~Stopwatch() {
    const double processor = counted_ ? loop_processor_seconds() - processor_ : 0;
    const double seconds = seconds_since(start_);
    if (counted_) spent_.latest = processor;
    // Of a call shorter than the asking, no more than there can be.
    spent_.processor += std::min(spent_.latest, threads() * seconds);
    spent_.seconds += seconds;
    spent_.offered += threads() * seconds;
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  Stopwatch(Spent& spent, bool asks) : spent_(spent) {
    if (!asks) return;
    counted_.emplace();
    processor_ = loop_processor_seconds();
  }

  static constexpr double long_enough = 1e-4;  // mean of a call, s

  Spent& spent_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::optional<CountedLoops> counted_;
  double processor_ = 0;
};

}  // namespace sphgeo
