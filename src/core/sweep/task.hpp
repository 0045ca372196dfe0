// What a sweep is asked for and where its results go: plain data, shared by kernels that are compiled for different
// instruction sets. Nothing here may be a function: it would be shared by them as well.
#pragma once

#include <cstddef>
#include <cstdint>

#include "model/joint.hpp"

namespace sweep_task {

enum Quantity : unsigned {
  omega_1 = 1,
  omega = 2,
  cond_H = 4,
  leg_length = 8,
  leg_distance = 16,
  leg_force = 32,
  lowest_stiffness = 64,
  joint_angle = 128,
  within_limits = 256,
  omega_1_gradient = 512
};

enum Status : std::uint8_t {
  ok = 0,
  singular = 1,    // beyond what float64 tells from a singular pose
  no_leg = 2,      // a leg without length, or along its universal axis
  not_finite = 3,  // the pose holds NaN or infinity
  no_inertia = 4   // the inertia matrix is not positive definite
};

struct Limits {
  double neutral[2][6][3];                  // leg directions in the middle of their joints: base axes, platform axes
  double length[6][2];                      // m
  double universal_angle, spherical_angle;  // rad
  double leg_distance;                      // m
};

struct Task {
  const double* design;  // its numbers, as in model/design.hpp
  core_enums::Joint joint;
  const double* poses;  // rows of 6 (position; roll, pitch, yaw) or 12 (position; rotation matrix by rows)
  int width;
  unsigned quantities;
  const Limits* limits;
  // Results, n rows of one or of six numbers; those not asked for may be null.
  double *omega_1_, *omega_, *cond_H_, *leg_length_, *leg_distance_, *leg_force_, *lowest_stiffness_;
  double *universal_angle_, *spherical_angle_, *omega_1_gradient_;
  bool* within_limits_;
  std::uint8_t* status_;
};

/// Natural frequencies of many designs: at all poses, or (paired) each design at the pose of its row.
struct DesignTask {
  const double* designs;  // rows of such numbers
  core_enums::Joint joint;
  const double* poses;  // rows of 12: position; rotation matrix by rows
  std::size_t poses_count;
  bool paired;
  int modes;      // 1: the lowest, 6: all
  double* omega;  // designs x poses (not paired) x modes
};

/// A kernel compiled for one instruction set.
struct Kernel {
  const char* name;
  bool (*runs_here)();
  void (*sweep)(const Task& task, std::size_t first, std::size_t last);
  void (*sweep_designs)(const DesignTask& task, std::size_t first, std::size_t last);
};

}  // namespace sweep_task
