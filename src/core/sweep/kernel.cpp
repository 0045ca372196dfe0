// The pose sweep for one instruction set. CMake compiles this file once for each, with `flexapod` defined as another
// name: then no inline function of one can stand in for that of another in the linked module.
#include "sweep/designs.hpp"
#include "sweep/frequencies.hpp"

namespace flexapod {
namespace {

constexpr int width = 2;  // vectors in a pack
using Lanes = Pack<Vector, width>;

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

void run(const sweep_task::Task& task, size_t first, size_t last) { Sweep<Lanes>(task).run(first, last); }

/// Twelve chains of multiply and add that do not depend on one another: enough for any processor's latency.
double peak(size_t rounds) {
  constexpr int chains = 12;
  Vector x[chains];
  const Vector a = 0.999999 - Vector{}, b = 1e-6 - Vector{};
  for (int i = 0; i < chains; ++i) x[i] = i + Vector{};
  for (size_t r = 0; r < rounds; ++r) {
    FLEXAPOD_UNROLL
    for (int i = 0; i < chains; ++i) x[i] = x[i] * a + b;
  }
  Vector sum = x[0];
  for (int i = 1; i < chains; ++i) sum += x[i];
  double lane[sizeof(Vector) / sizeof(double)];
  std::memcpy(lane, &sum, sizeof(sum));
  [[maybe_unused]] volatile double needed;  // or a compiler would leave all of it out
  for (const double number : lane) needed = number;
  return 2.0 * chains * static_cast<double>(rounds) * (sizeof(Vector) / sizeof(double));
}

void sweep_designs(const DesignTask& task, size_t first, size_t last) { DesignSweep<Lanes>(task, first, last); }

}  // namespace

extern const sweep_task::Kernel sweep_kernel;
const sweep_task::Kernel sweep_kernel = {FLEXAPOD_ISA, &runs_here, &run, &sweep_designs, &peak};

}  // namespace flexapod
