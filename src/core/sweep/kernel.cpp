// The pose sweep for one instruction set. CMake compiles this file once for each, with `flexapod` defined as another
// name: then no inline function of one can stand in for that of another in the linked module.
#include "sweep/designs.hpp"
#include "sweep/frequencies.hpp"

namespace flexapod {
namespace {

constexpr int width = 2;  // vectors in a pack
using Lanes = Pack<Vector, width, Division::quick>;

bool runs_here() {
#if defined(__AVX512F__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd");
#elif defined(__AVX2__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return true;
#endif
}

void run(const sweep_task::Task& task, size_t first, size_t last) {
  const Features features(*reinterpret_cast<const Design<double>*>(task.design));
  if (features.others()) Sweep<Lanes, Swept::others>(task).run(first, last);
  else Sweep<Lanes, Swept::along_legs>(task).run(first, last);
}

void sweep_designs(const DesignTask& task, size_t first, size_t last) {
  if (task.joints || task.suspension) DesignSweep<Lanes, Swept::others>(task, first, last);
  else DesignSweep<Lanes, Swept::along_legs>(task, first, last);
}

}  // namespace

extern const sweep_task::Kernel sweep_kernel;
const sweep_task::Kernel sweep_kernel = {FLEXAPOD_ISA, &runs_here, &run, &sweep_designs};

}  // namespace flexapod
