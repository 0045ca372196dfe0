// The pose sweep as Python sees it: the kernel for this processor, threads over blocks of poses.
#include "bindings/sweep.hpp"

#include <cstdlib>
#include <cstring>

#include "bindings/parallel_for.hpp"

#if defined(FLEXAPOD_X86)
namespace flexapod_avx512 {
extern const sweep_task::Kernel sweep_kernel;
}
namespace flexapod_avx2 {
extern const sweep_task::Kernel sweep_kernel;
}
#endif
namespace flexapod_baseline {
extern const sweep_task::Kernel sweep_kernel;
}

namespace flexapod {
namespace {

using sweep_task::Kernel;
using sweep_task::Task;

/// Best first.
constexpr const Kernel* kernels[] = {
#if defined(FLEXAPOD_X86)
    &flexapod_avx512::sweep_kernel, &flexapod_avx2::sweep_kernel,
#endif
    &flexapod_baseline::sweep_kernel};

/// The best kernel that runs here, or the one that the environment variable FLEXAPOD_SIMD names.
const Kernel& choose_kernel() {
  const char* wanted = std::getenv("FLEXAPOD_SIMD");
  std::string names;
  for (const Kernel* kernel : kernels) {
    if (!kernel->runs_here()) continue;
    if (wanted == nullptr || *wanted == '\0' || std::strcmp(wanted, kernel->name) == 0) return *kernel;
    names += std::string(names.empty() ? "" : ", ") + kernel->name;
  }
  throw std::runtime_error("FLEXAPOD_SIMD is '" + std::string(wanted) + "'; this processor and build offer " + names +
                           ". Set it to one of these, or leave it unset for the best.");
}

const Kernel* chosen = nullptr;

struct Array {
  const char* name;
  sweep_task::Quantity quantity;
  double* Task::* place;
  size_t columns;
};
constexpr Array arrays[] = {
    {"omega_1", sweep_task::omega_1, &Task::omega_1_, 1},
    {"omega", sweep_task::omega, &Task::omega_, 6},
    {"cond_H", sweep_task::cond_H, &Task::cond_H_, 1},
    {"leg_length", sweep_task::leg_length, &Task::leg_length_, 6},
    {"leg_distance", sweep_task::leg_distance, &Task::leg_distance_, 1},
    {"leg_force", sweep_task::leg_force, &Task::leg_force_, 1},
    {"lowest_stiffness", sweep_task::lowest_stiffness, &Task::lowest_stiffness_, 1},
    {"universal_angle", sweep_task::joint_angle, &Task::universal_angle_, 6},
    {"spherical_angle", sweep_task::joint_angle, &Task::spherical_angle_, 6},
    {"omega_1_gradient", sweep_task::omega_1_gradient, &Task::omega_1_gradient_, 6},
};

/// A pose's result does not depend on its block.
void run(const Task& task, size_t n, int threads) {
  in_blocks(n, 2048, threads, [&](size_t first, size_t last) { chosen->sweep(task, first, last); });
}

template <class Number> nb::ndarray<nb::numpy, Number> owned(std::unique_ptr<Number[]> data, size_t n, size_t columns) {
  Number* raw = data.release();
  nb::capsule owner(raw, [](void* p) noexcept { delete[] static_cast<Number*>(p); });
  const size_t shape[] = {n, columns};
  return {raw, columns == 1 ? size_t{1} : size_t{2}, shape, owner};
}

/// A task and the arrays of its results.
struct Job {
  Task task{};
  size_t n;
  std::unique_ptr<double[]> numbers[std::size(arrays)];
  std::unique_ptr<bool[]> within;
  std::unique_ptr<std::uint8_t[]> status;

  Job(const Input& design, Joint joint, const Input& poses, sweep_task::Quantity quantities) {
    if (poses.ndim() != 2 || (poses.shape(1) != 6 && poses.shape(1) != 12))
      throw std::invalid_argument("poses must have shape (n, 6) or (n, 12)");
    n = poses.shape(0);
    task.design = rows(design, 1, design_size, "design");
    task.joint = joint;
    task.poses = poses.data();
    task.width = static_cast<int>(poses.shape(1));
    task.quantities = quantities;
    for (size_t i = 0; i < std::size(arrays); ++i)
      if (quantities & arrays[i].quantity) {
        numbers[i].reset(new double[n * arrays[i].columns]);
        task.*arrays[i].place = numbers[i].get();
      }
    if (quantities & sweep_task::within_limits) within.reset(new bool[n]);
    status.reset(new std::uint8_t[n]);
    task.within_limits_ = within.get();
    task.status_ = status.get();
  }
};

nb::dict sweep_(const Input& design, Joint joint, const Input& poses, sweep_task::Quantity quantities,
                const Input& limits, int threads) {
  if (threads < 1) throw std::invalid_argument("threads is " + std::to_string(threads) + "; it must be >= 1");
  Job job(design, joint, poses, quantities);
  job.task.limits = reinterpret_cast<const sweep_task::Limits*>(rows(limits, 1, sweep_task::limits_size, "limits"));
  {
    nb::gil_scoped_release release;
    run(job.task, job.n, threads);
  }
  nb::dict result;
  for (size_t i = 0; i < std::size(arrays); ++i)
    if (job.numbers[i]) result[arrays[i].name] = owned(std::move(job.numbers[i]), job.n, arrays[i].columns);
  if (job.within) result["within_limits"] = owned(std::move(job.within), job.n, 1);
  result["status"] = owned(std::move(job.status), job.n, 1);
  return result;
}

/// The mean over the poses.
double sweep_flops(const Input& design, Joint joint, const Input& poses, sweep_task::Quantity quantities) {
  const sweep_task::Limits no_limits{};
  Job job(design, joint, poses, quantities);
  job.task.limits = &no_limits;
  return count_flops(job.task, job.n) / static_cast<double>(job.n);
}

nb::tuple simd_available() {
  nb::list names;
  for (const Kernel* kernel : kernels)
    if (kernel->runs_here()) names.append(kernel->name);
  return nb::tuple(names);
}

}  // namespace

const Kernel& kernel_in_use() { return *chosen; }

void bind_sweep(nb::module_& m) {
  chosen = &choose_kernel();
  m.def("sweep", &sweep_);
  m.def("sweep_flops", &sweep_flops);
  m.attr("compiler") = FLEXAPOD_COMPILER;
  m.def("simd", [] { return chosen->name; });
  m.def("simd_available", &simd_available);
  m.def("peak_flops", [](size_t rounds) { return chosen->peak(rounds); }, nb::call_guard<nb::gil_scoped_release>());
  nb::dict asked;
  for (const Array& array : arrays) asked[array.name] = array.quantity;
  asked["within_limits"] = sweep_task::within_limits;
  m.attr("SWEEP_ARRAYS") = asked;
}

}  // namespace flexapod
