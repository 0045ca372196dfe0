#pragma once

#include "arrays.hpp"
#include "sweep_task.hpp"

namespace flexapod {

/// Adds the pose sweep to the module.
void bind_sweep(nb::module_& m);

/// The kernel that `bind_sweep` chose for this processor.
const sweep_task::Kernel& kernel_in_use();

}  // namespace flexapod
