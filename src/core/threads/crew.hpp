// Threads that work while the thread that started them does something else, such as listening for an interrupt.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace flexapod {

/// Runs job(i) for all i < n. Jobs that have begun may look at `stop`; once it is set, no other begins.
class Crew {
 public:
  std::atomic<bool> stop{false};

  Crew(std::size_t n, std::size_t threads, std::function<void(std::size_t)> job)
      : n_(n), job_(std::move(job)), running_(std::min(n, threads)) {
    for (std::size_t worker = running_; worker > 0; --worker) workers_.emplace_back([this] { work(); });
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() {
    stop = true;
    for (std::thread& worker : workers_) worker.join();
  }

  /// Waits until all is done, or for that time; true if all is done.
  bool wait_for(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return finished_.wait_for(lock, time, [&] { return running_ == 0; });
  }

 private:
  void work() {
    for (std::size_t i; !stop && (i = next_++) < n_;) job_(i);
    const std::lock_guard lock(mutex_);
    if (--running_ == 0) finished_.notify_all();
  }

  const std::size_t n_;
  const std::function<void(std::size_t)> job_;
  std::atomic<std::size_t> next_{0}, running_;
  std::mutex mutex_;
  std::condition_variable finished_;
  std::vector<std::thread> workers_;
};

}  // namespace flexapod
