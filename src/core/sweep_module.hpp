#pragma once

#include "arrays.hpp"

namespace flexapod {

/// Adds the pose sweep to the module.
void bind_sweep(nb::module_& m);

}  // namespace flexapod
