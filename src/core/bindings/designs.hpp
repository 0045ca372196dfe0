#pragma once

#include <nanobind/nanobind.h>

namespace flexapod {

/// Adds what searches over designs need: frequencies of many designs, derivatives along directions of the design.
void bind_designs(nanobind::module_& m);

}  // namespace flexapod
