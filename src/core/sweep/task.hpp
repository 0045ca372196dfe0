// What a sweep is asked for and where its results go: plain data, shared by kernels that are compiled for different
// instruction sets. Nothing here may be a function: it would be shared by them as well.
#pragma once

#include <cstddef>
#include <cstdint>

#include "model/joint.hpp"
#include "model/stiffness_law.hpp"

namespace sweep_task {

// QUANTITY(name): what a sweep can be asked for.
#define FLEXAPOD_SWEEP_QUANTITIES(QUANTITY) \
  QUANTITY(omega_1)                         \
  QUANTITY(omega)                           \
  QUANTITY(cond_H)                          \
  QUANTITY(leg_length)                      \
  QUANTITY(leg_distance)                    \
  QUANTITY(leg_force)                       \
  QUANTITY(lowest_stiffness)                \
  QUANTITY(joint_angle)                     \
  QUANTITY(within_limits)                   \
  QUANTITY(omega_1_gradient)                \
  QUANTITY(joint_moment)                    \
  QUANTITY(rpy)

// ARRAY(name, quantity, columns): the arrays of numbers that come back, and what to ask for to get them.
#define FLEXAPOD_SWEEP_ARRAYS(ARRAY)           \
  ARRAY(omega_1, omega_1, 1)                   \
  ARRAY(omega, omega, 6)                       \
  ARRAY(cond_H, cond_H, 1)                     \
  ARRAY(leg_length, leg_length, 6)             \
  ARRAY(leg_distance, leg_distance, 1)         \
  ARRAY(leg_force, leg_force, 1)               \
  ARRAY(lowest_stiffness, lowest_stiffness, 1) \
  ARRAY(universal_angle, joint_angle, 6)       \
  ARRAY(spherical_angle, joint_angle, 6)       \
  ARRAY(universal_moment, joint_moment, 6)     \
  ARRAY(spherical_moment, joint_moment, 6)     \
  ARRAY(omega_1_gradient, omega_1_gradient, 6) \
  ARRAY(rpy, rpy, 3)

#define FLEXAPOD_NUMBERED(name) name,
enum class QuantityNumber : unsigned { FLEXAPOD_SWEEP_QUANTITIES(FLEXAPOD_NUMBERED) };
#define FLEXAPOD_BIT(name) name = 1u << static_cast<unsigned>(QuantityNumber::name),
enum Quantity : unsigned { FLEXAPOD_SWEEP_QUANTITIES(FLEXAPOD_BIT) };

enum Status : std::uint8_t {
  ok = 0,
  singular = 1,              // beyond what float64 tells from a singular pose
  no_leg = 2,                // a leg without length, or along its universal axis
  not_finite = 3,            // the pose holds NaN or infinity
  no_inertia = 4,            // the inertia matrix is not positive definite
  outside_stiffness_law = 5  // a leg has a length at which its stiffness law says nothing
};

struct Limits {
  double neutral[2][6][3];                    // leg directions in the middle of their joints: base axes, platform axes
  double length[6][2];                        // m
  double universal_angle, spherical_angle;    // rad
  double universal_moment, spherical_moment;  // of springs that bend, N m
  double leg_distance;                        // m
};

/// Where poses are, and by how many numbers their rotations are given.
struct Poses {
  const double *position, *rotation;  // of the first pose
  std::size_t step, turn_step;        // numbers from one position and from one rotation to the next
  int turned;  // 3: roll, pitch, yaw; 4: a quaternion of length one, its scalar last; 9: a matrix
};

struct Task {
  const double* design;  // its numbers, as in model/design.hpp
  core_enums::Joint joint;
  Poses poses;
  unsigned quantities;
  const Limits* limits;
  // Results, n rows of one, three or six numbers; those not asked for may be null.
#define FLEXAPOD_RESULT(name, quantity, columns) double* name##_;
  FLEXAPOD_SWEEP_ARRAYS(FLEXAPOD_RESULT)
  bool* within_limits_;
  std::uint8_t* status_;
};

/// Natural frequencies of many designs: at all poses, or (paired) each design at the pose of its row.
struct DesignTask {
  const double* designs;  // rows of such numbers
  core_enums::Joint joint;
  core_enums::Law law;              // of all of them
  bool series, joints, suspension;  // springs that any of them has
  const double* poses;              // rows of 12: position; rotation matrix by rows
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
