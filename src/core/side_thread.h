#pragma once
// A thread beside the loops, for work that waits for the disk.

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace sphgeo {

/// Runs tasks in the order in which they are given, one at a time, beside the thread that gives
/// them. None waits in a queue: what a task holds in memory exists once. After a task has thrown,
/// no other one is begun. Loops in a task run in its thread alone. All functions are called from
/// one thread.
class SideThread {
 public:
  SideThread() = default;
  /// Waits for the end of the task. What it throws then is lost: call wait() before.
  ~SideThread();
  SideThread(const SideThread&) = delete;
  SideThread& operator=(const SideThread&) = delete;

  /// Whether no task is under way.
  bool idle() const;
  /// Throws what a task has thrown, at every call from then on; does not wait.
  void check() const;
  /// Waits for the end of the task; throws as check().
  void wait() const;
  /// Waits for the end of the task before, then begins this one; throws as check(). Where the
  /// system gives no thread the task runs at once.
  void begin(std::function<void()> task);
  /// Processor time of the tasks that have ended, s.
  double processor_seconds() const;

 private:
  void serve();
  void rethrow() const;

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::function<void()> task_;
  std::exception_ptr failure_;
  bool under_way_ = false, stop_ = false;
  double processor_ = 0;  ///< s
  std::thread thread_;    ///< starts with the first task
};

}  // namespace sphgeo
