#pragma once

#include <nanobind/nanobind.h>

#include "simulation/task.hpp"

namespace flexapod {

/// The kernel that `bind_simulation` chose for this processor: after `bind_sweep`, which asks the processor.
const simulation_task::Kernel& simulation_kernel_in_use();

void bind_simulation(nanobind::module_& m);

}  // namespace flexapod
