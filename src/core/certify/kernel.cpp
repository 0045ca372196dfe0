// Certificates for one instruction set, compiled as sweep/kernel.cpp is. Nothing in here may be compiled by options that
// change values: rounding is bounded for IEEE arithmetic, with or without fused multiplication.
#include <algorithm>
#include <iterator>
#include <new>

#include "certify/looking.hpp"

#if defined(__FAST_MATH__)
#error "bounds of rounding do not hold with -ffast-math"
#endif

namespace flexapod {
namespace {

using Lanes = Pack<Vector, 1>;
struct Worker {
  virtual ~Worker() = default;
  virtual void look(double level, const Box* boxes, int count, Finding* found) = 0;
};
template <int n, int strays> struct WorkerOf final : Worker {
  Looking<Lanes, n, strays> looking;

  explicit WorkerOf(const Task& task) : looking(task) {}
  void look(double level, const Box* boxes, int count, Finding* found) override {
    looking.look(level, boxes, count, found);
  }
};
using BoxWorker = WorkerOf<6, 0>;
using PathWorker = WorkerOf<1, 0>;
using StrayingBoxWorker = WorkerOf<6, certify_task::most_strays>;
using StrayingPathWorker = WorkerOf<1, certify_task::most_strays>;
constexpr std::size_t sizes[] = {sizeof(BoxWorker), sizeof(PathWorker), sizeof(StrayingBoxWorker),
                                 sizeof(StrayingPathWorker)};

void prepare(const Task& task, void* memory) {
  const bool path = task.pieces != nullptr;
  if (task.strays > 0 && path) new (memory) StrayingPathWorker(task);
  else if (task.strays > 0) new (memory) StrayingBoxWorker(task);
  else if (path) new (memory) PathWorker(task);
  else new (memory) BoxWorker(task);
}
void look(void* memory, double level, const Box* boxes, int count, Finding* found) {
  static_cast<Worker*>(memory)->look(level, boxes, count, found);
}
void finish(void* memory) { static_cast<Worker*>(memory)->~Worker(); }

}  // namespace

extern const certify_task::Kernel certify_kernel;
const certify_task::Kernel certify_kernel = {Lanes::lanes, *std::max_element(std::begin(sizes), std::end(sizes)),
                                             &prepare, &look, &finish};

}  // namespace flexapod
