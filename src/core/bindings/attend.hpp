// Long calls: the core works on other threads while Python is heard.
#pragma once

#include "bindings/unlocked.hpp"
#include "threads/crew.hpp"

namespace flexapod {

/// Waits for a crew while Python's interrupts are heard and progress, `done()`, is reported. It ends early, with false,
/// where the report answers False.
template <class Done> bool attend(Crew& crew, Done&& done, const nanobind::object& report) {
  for (bool finished = false; !finished;) {
    {
      const Unlocked unlocked;
      finished = crew.wait_for(std::chrono::milliseconds(50));
    }
    if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
    if (!report.is_none() && with_python([&] { return report(done()); }).ptr() == Py_False) return false;
  }
  return true;
}

}  // namespace flexapod
