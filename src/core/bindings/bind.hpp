// What module.cpp registers, subject by subject.
#pragma once

#include <nanobind/nanobind.h>

namespace flexapod {

/// The layouts of design and motion, the enumerations, and the instruction set in use.
void bind_types(nanobind::module_& m);
/// Functions of a design and of motions.
void bind_mechanics(nanobind::module_& m);
/// Calls for one pose, and the handle for loops.
void bind_one_pose(nanobind::module_& m);
/// Checks and conversions of rotations.
void bind_rotations(nanobind::module_& m);
/// The sweep over poses.
void bind_sweep(nanobind::module_& m);
/// Certificates over boxes of poses and along paths.
void bind_certify(nanobind::module_& m);
/// What searches over designs need: frequencies of many designs, derivatives along directions of the design.
void bind_designs(nanobind::module_& m);
/// Simulations, controllers in them, and the excitations that drive them.
void bind_simulation(nanobind::module_& m);

}  // namespace flexapod
