// Certificates for one instruction set, compiled as sweep/kernel.cpp is. Nothing in here may be compiled by options that
// change values: rounding is bounded for IEEE arithmetic, with or without fused multiplication.
#include <new>

#include "certify/looking.hpp"

#if defined(__FAST_MATH__)
#error "bounds of rounding do not hold with -ffast-math"
#endif

namespace flexapod {
namespace {

using Lanes = Pack<Vector, 1>;
using BoxLooking = Looking<Lanes, 6>;
using PathLooking = Looking<Lanes, 1>;

/// One of the two, in memory that the caller gives.
struct Worker {
  bool path;
  alignas(64) union Both {
    BoxLooking box;
    PathLooking path;
    Both() {}
    ~Both() {}
  } of;

  explicit Worker(const Task& task) : path(task.pieces != nullptr) {
    if (path) new (&of.path) PathLooking(task);
    else new (&of.box) BoxLooking(task);
  }
  ~Worker() {
    if (path) of.path.~PathLooking();
    else of.box.~BoxLooking();
  }
};

void prepare(const Task& task, void* memory) { new (memory) Worker(task); }
void look(void* memory, double level, const Box* boxes, int count, Finding* found) {
  Worker& worker = *static_cast<Worker*>(memory);
  if (worker.path) worker.of.path.look(level, boxes, count, found);
  else worker.of.box.look(level, boxes, count, found);
}
void finish(void* memory) { static_cast<Worker*>(memory)->~Worker(); }

}  // namespace

extern const certify_task::Kernel certify_kernel;
const certify_task::Kernel certify_kernel = {Lanes::lanes, sizeof(Worker), &prepare, &look, &finish};

}  // namespace flexapod
