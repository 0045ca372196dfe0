#pragma once

#include <nanobind/nanobind.h>

namespace flexapod {

void bind_simulation(nanobind::module_& m);

}  // namespace flexapod
