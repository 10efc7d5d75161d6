#include "core/side_thread.h"

#include <time.h>

#include <system_error>
#include <utility>

#include "core/parallel.h"

namespace sphgeo {
namespace {

double processor_of_thread() {
  timespec spent{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

}  // namespace

SideThread::~SideThread() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool SideThread::idle() const {
  const std::lock_guard lock(mutex_);
  return !under_way_;
}

void SideThread::check() const {
  const std::lock_guard lock(mutex_);
  rethrow();
}

void SideThread::wait() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !under_way_; });
  rethrow();
}

void SideThread::begin(std::function<void()> task) {
  wait();
  if (!thread_.joinable()) {
    try {
      thread_ = std::thread([this] { serve(); });
    } catch (const std::system_error&) {
      task();
      return;
    }
  }
  {
    const std::lock_guard lock(mutex_);
    task_ = std::move(task);
    under_way_ = true;
  }
  changed_.notify_all();
}

void SideThread::serve() {
  keep_loops_to_this_thread();
  for (;;) {
    std::function<void()> task;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return under_way_ || stop_; });
      if (!under_way_) return;
      task = std::move(task_);
    }
    std::exception_ptr failure;
    try {
      task();
    } catch (...) {
      failure = std::current_exception();
    }
    task = nullptr;  // its memory is free before the next task is made
    {
      const std::lock_guard lock(mutex_);
      failure_ = failure;
      processor_ = processor_of_thread();
      under_way_ = false;
    }
    changed_.notify_all();
  }
}

double SideThread::processor_seconds() const {
  const std::lock_guard lock(mutex_);
  return processor_;
}

void SideThread::rethrow() const {
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace sphgeo
