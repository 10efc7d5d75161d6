#include "core/parallel.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#if defined(__linux__)
#include <sched.h>
#endif

namespace sphgeo {
namespace {

// Tells the processor that this is a loop of waiting.
void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

// Processors that this process may use.
int processors() {
#if defined(__linux__)
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
#endif
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

thread_local bool alone = false;

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

using clock_type = std::chrono::steady_clock;

// How often a thread looks for work, or for the end of a loop, before it goes to sleep: some ten
// microseconds. That spans the gaps between two loops of a step, and costs other programs little.
constexpr int looks = 1000;
// Where a block takes longer, the threads of a loop end that much apart; to be woken takes longer
// than to look on until then. No longer than this, as that is for other programs too.
constexpr auto longest_look = std::chrono::microseconds(200);

/// Looks whether there is an end of waiting; returns when there is, or after `patience`.
template <class F>
void look_for(clock_type::duration patience, F&& over) {
  for (int k = 0; k < looks && !over(); ++k) relax();
  if (patience <= clock_type::duration::zero()) return;
  for (const auto start = clock_type::now(); !over() && clock_type::now() - start < patience;)
    for (int k = 0; k < 50 && !over(); ++k) relax();
}

/// Threads that wait for loops. A loop hands out its blocks one by one; the thread that asks for it
/// works along, and at the end waits only for those that took part. So on a busy machine a thread
/// that gets no processor delays nobody, as it would at a barrier of all.
class Workers {
 public:
  ~Workers() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
      ++loop_;
    }
    wake_.notify_all();
    for (std::thread& t : threads_) t.join();
  }

  /// Processor time that all but the thread that asks for a loop have taken in it, less that in
  /// which the latter waited for its end, s.
  double seconds_elsewhere() const { return elsewhere_; }
  /// Processor time of all threads in loops, s.
  double seconds_in_loops() const { return shared_; }
  void count_time(bool on) { counting_ += on ? 1 : -1; }

  void set_count(int n) { count_ = std::max(n, 1); }
  int count() const { return count_; }

  void run(Index blocks, void (*call)(const void*, Index), const void* context) {
    // A loop within a loop runs in the thread at hand.
    if (alone || count_ == 1 || blocks < 2 || busy_.exchange(true)) {
      Failure failure;
      for (Index b = 0; b < blocks; ++b) try_block(call, context, b, failure);
      failure.rethrow();
      return;
    }
    while (static_cast<int>(threads_.size()) < count_ - 1)
      threads_.emplace_back([this, index = static_cast<int>(threads_.size())] { serve(index); });
    {
      const std::lock_guard lock(mutex_);
      call_ = call;
      context_ = context;
      blocks_ = blocks;
      next_ = 0;
      failure_ = {};
      open_ = true;
      ++loop_;
    }
    wake_.notify_all();
    const bool counts = counting_ > 0;
    const double begun = counts ? thread_seconds() : 0;
    const auto start = clock_type::now();
    if (const Index own = take_blocks(); own > 0) {
      const auto two_blocks = 2 * (clock_type::now() - start) / own;
      patience_ = std::min<clock_type::duration>(two_blocks, longest_look);
    }
    Failure failure;
    {
      const double before = counts ? thread_seconds() : -1;
      if (counts) shared_ += before - begun;
      look_for(patience_, [&] { return active_ == 0; });
      std::unique_lock lock(mutex_);
      open_ = false;
      done_.wait(lock, [&] { return active_ == 0; });
      failure = std::move(failure_);
      if (before >= 0) elsewhere_ -= thread_seconds() - before;  // waiting is no work
    }
    busy_ = false;
    failure.rethrow();
  }

 private:
  // The exception of the first failing block.
  struct Failure {
    Index block = -1;
    std::exception_ptr what;

    void keep(Index b, std::exception_ptr e) {
      if (block >= 0 && block < b) return;
      block = b;
      what = std::move(e);
    }
    void rethrow() const {
      if (what) std::rethrow_exception(what);
    }
  };

  static void try_block(void (*call)(const void*, Index), const void* context, Index b,
                        Failure& failure) {
    try {
      call(context, b);
    } catch (...) {
      failure.keep(b, std::current_exception());
    }
  }

  /// Returns how many it took.
  Index take_blocks() {
    Failure failure;
    Index taken = 0;
    for (Index b; (b = next_.fetch_add(1, std::memory_order_relaxed)) < blocks_; ++taken)
      try_block(call_, context_, b, failure);
    if (!failure.what) return taken;
    const std::lock_guard lock(mutex_);
    failure_.keep(failure.block, failure.what);
    return taken;
  }

  void serve(int index) {
    for (std::uint64_t seen = 0;;) {
      look_for(patience_, [&] { return loop_ != seen; });
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return loop_ != seen; });
      if (stop_) return;
      seen = loop_;
      if (!open_ || index >= count_ - 1) continue;
      ++active_;
      lock.unlock();
      const double before = counting_ > 0 ? thread_seconds() : -1;
      take_blocks();
      if (before >= 0) {
        const double taken = thread_seconds() - before;
        elsewhere_ += taken;
        shared_ += taken;
      }
      lock.lock();
      if (--active_ == 0) done_.notify_one();
    }
  }

  std::atomic<int> count_ = processors();
  std::vector<std::thread> threads_;
  std::atomic<bool> busy_ = false;

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::atomic<std::uint64_t> loop_ = 0;  // number of the loop
  std::atomic<int> active_ = 0;          // workers that take part in it
  bool open_ = false;                    // whether more may join
  bool stop_ = false;

  // The loop. Written only while nobody takes part.
  void (*call_)(const void*, Index) = nullptr;
  const void* context_ = nullptr;
  Index blocks_ = 0;
  std::atomic<Index> next_ = 0;
  Failure failure_;

  std::atomic<clock_type::duration> patience_ = clock_type::duration::zero();  // see look_for
  std::atomic<int> counting_ = 0;
  std::atomic<double> elsewhere_ = 0, shared_ = 0;
};

// One for the process: threads are a resource of the machine, and hold no state of a scene.
Workers& workers() {
  static Workers all;
  return all;
}

}  // namespace

void set_threads(int n) { workers().set_count(n); }

int threads() { return workers().count(); }

double loop_processor_seconds() { return thread_seconds() + workers().seconds_elsewhere(); }

double shared_processor_seconds() { return workers().seconds_in_loops(); }

CountedLoops::CountedLoops() { workers().count_time(true); }
CountedLoops::~CountedLoops() { workers().count_time(false); }

void keep_loops_to_this_thread() { alone = true; }

void detail::run_blocks(Index blocks, void (*call)(const void* context, Index b),
                        const void* context) {
  workers().run(blocks, call, context);
}

}  // namespace sphgeo
