// Work without Python's lock, from a thread that may outlive Python. A daemon thread that asks for the lock when the
// interpreter ends is ended within that call, until Python 3.14: on Linux by an exception that no destructor may let
// pass, which would abort the process. Such a thread waits here, and the end of the process ends it.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <exception>
#include <thread>

namespace flexapod {

/// Calls what takes Python's lock; does not return where Python has ended.
template <class Call> decltype(auto) with_python(Call&& call) {
  try {
    return call();
  } catch (const std::exception&) {
    throw;
  } catch (...) {  // the end of this thread, which must not be caught and left
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }
}

/// Python's lock is given up as long as one of these lives.
class Unlocked {
  PyThreadState* const state_ = PyEval_SaveThread();

 public:
  Unlocked() = default;
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
  ~Unlocked() {
    with_python([this] { PyEval_RestoreThread(state_); });
  }
};

}  // namespace flexapod
