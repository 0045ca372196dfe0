// The kernels that are compiled for each instruction set, and the choice among them.
#pragma once

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include "certify/task.hpp"
#include "one_pose/task.hpp"
#include "simulation/task.hpp"
#include "sweep/task.hpp"

#define FLEXAPOD_KERNELS_OF(isa)                            \
  namespace flexapod_##isa {                                \
    extern const sweep_task::Kernel sweep_kernel;           \
    extern const certify_task::Kernel certify_kernel;       \
    extern const one_pose_task::Kernel one_pose_kernel;     \
    extern const simulation_task::Kernel simulation_kernel; \
  }
#if defined(FLEXAPOD_AVX512)
FLEXAPOD_KERNELS_OF(avx512)
#endif
#if defined(FLEXAPOD_AVX2)
FLEXAPOD_KERNELS_OF(avx2)
#endif
FLEXAPOD_KERNELS_OF(baseline)
#undef FLEXAPOD_KERNELS_OF

namespace flexapod {

struct Kernels {
  const sweep_task::Kernel& sweep;
  const certify_task::Kernel& certify;
  const one_pose_task::Kernel& one_pose;
  const simulation_task::Kernel& simulation;

  const char* name() const { return sweep.name; }
  bool runs_here() const { return sweep.runs_here(); }
};

/// All that this build has, the best first.
inline constexpr Kernels all_kernels[] = {
#if defined(FLEXAPOD_AVX512)
    {flexapod_avx512::sweep_kernel, flexapod_avx512::certify_kernel, flexapod_avx512::one_pose_kernel,
     flexapod_avx512::simulation_kernel},
#endif
#if defined(FLEXAPOD_AVX2)
    {flexapod_avx2::sweep_kernel, flexapod_avx2::certify_kernel, flexapod_avx2::one_pose_kernel,
     flexapod_avx2::simulation_kernel},
#endif
    {flexapod_baseline::sweep_kernel, flexapod_baseline::certify_kernel, flexapod_baseline::one_pose_kernel,
     flexapod_baseline::simulation_kernel}};

/// The best kernels that run here, or those that the environment variable FLEXAPOD_SIMD names.
inline const Kernels& choose_kernels() {
  const char* wanted = std::getenv("FLEXAPOD_SIMD");
  std::string names;
  for (const Kernels& kernels : all_kernels) {
    if (!kernels.runs_here()) continue;
    if (wanted == nullptr || *wanted == '\0' || std::strcmp(wanted, kernels.name()) == 0) return kernels;
    names += std::string(names.empty() ? "" : ", ") + kernels.name();
  }
  throw std::runtime_error("FLEXAPOD_SIMD is '" + std::string(wanted) + "'; this processor and build offer " + names +
                           ". Set it to one of these, or leave it unset for the best.");
}

/// Those in use, chosen at the first call.
inline const Kernels& kernels() {
  static const Kernels& chosen = choose_kernels();
  return chosen;
}

}  // namespace flexapod
