#pragma once

#include "bindings/arrays.hpp"
#include "sweep/task.hpp"

namespace flexapod {

/// Adds the pose sweep to the module.
void bind_sweep(nb::module_& m);

/// The kernel that `bind_sweep` chose for this processor.
const sweep_task::Kernel& kernel_in_use();

/// Sums, products, quotients and roots that n poses of a task take, each pose by itself.
double count_flops(const sweep_task::Task& task, size_t n);

}  // namespace flexapod
