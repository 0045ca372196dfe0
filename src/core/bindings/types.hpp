#pragma once

#include <nanobind/nanobind.h>

namespace flexapod {

/// Adds the layouts of design and motion, and the enumerations.
void bind_types(nanobind::module_& m);

}  // namespace flexapod
