// What simulations are asked for and where their results go: plain data, shared by kernels that are compiled for
// different instruction sets. Nothing here may be a function: it would be shared by them as well.
#pragma once

#include <atomic>
#include <cstddef>

#include "model/joint.hpp"

namespace simulation_task {

inline constexpr std::size_t pose_size = 12, motion_size = 24;

/// How a simulation ended.
enum class Outcome {
  complete,
  singular,
  leg_collapsed,
  joint_locked,
  step_collapse,
  not_finite,
  max_steps,
  stopped,
  outside_stiffness_law
};

/// What sensors show, six numbers each, as changes from rest: leg lengths, their rates, leg forces, displacement of the
/// platform as seen from the base and its rate, absolute acceleration.
enum class Measure { leg_length, leg_rate, leg_force, position, velocity, acceleration };
inline constexpr std::size_t measures = 6, signals = 6 * measures;

/// The numbers of an excitation.
struct Series {
  const double* numbers;
  std::size_t size;
};

/// A machine at rest and what drives it. Inertial axes, save `wrench`.
struct Machine {
  const double* design;  // its numbers, as in model/design.hpp
  core_enums::Joint joint;
  double platform[pose_size], base[pose_size];  // poses at rest
  double leg_force[6];                          // at that pose with no command, N
  double wrench[6];                             // constant part of the external wrench, platform axes
  double displacement[6], velocity[6];          // of the platform from rest at t = 0 (translation, rotation)
  bool roll_pitch_yaw;                          // the base's rotation channels: else a rotation vector
  bool carried;                                 // starts moving rigidly with the base; else from the two above
  Series base_motion, load, command;
};

struct Options {
  double rtol, atol;           // of the displacement at the platform's joints: relative, and m (0: rounding)
  double max_step, max_steps;  // s; of one simulation
  bool stop_at_singular;       // end where det H changes sign
  bool motions;                // keep motions of platform and base, and leg forces
  bool works;                  // integrate works beside the motion
  bool exponential;            // take exponential steps where they are worth it
  int threads;
};

/// Where the samples of one simulation go: rows for the instants given. The last three may be null.
struct Samples {
  const double* times;
  std::size_t count;
  double *displacement, *relative, *work, *platform, *base, *leg_force;
};

struct Run {
  const Machine& machine;
  Options options;
  Samples samples;
  const std::atomic<bool>* stop;
  std::atomic<double>* progress;
};

struct End {
  Outcome outcome;
  double time;                             // reached
  double last[motion_size];                // the platform's motion then, inertial axes
  double accepted, rejected, evaluations;  // steps, and calls of the equations of motion
  double exponential;                      // steps among those accepted
};

/// x[k+1] = A x + B (y + noise), f = C x + D (y + noise), clipped to +-limit.
struct Controller {
  std::size_t order;
  const double *A, *B, *C, *D;  // rows of order, 36, order, 36 numbers
  const double* limit;          // (6) N
};

struct Timing {
  double dt;
  std::size_t count, steps;
};

/// Rows for every step's end, from t = 0: measurements without noise and absolute displacement. Rows for every sample:
/// forces, and whether one was cut off.
struct Record {
  double *measured, *displacement, *force, *cut;
};

struct Loop {
  const Machine& machine;
  Controller controller;
  Timing timing;
  const double* noise;  // rows of 36 for every sample
  Record record;
  const std::atomic<bool>* stop;
  std::atomic<double>* progress;
};

/// Many states of one machine: rows of 24, 24, 6 and 6 numbers, the wrench in platform axes; accelerations, rows of 6.
struct States {
  const double* design;
  core_enums::Joint joint;
  std::size_t count;
  const double *platform, *base, *leg_force, *wrench;
  double* acceleration;
};

/// A kernel compiled for one instruction set. `equations` are those of one simulation, y' = rates(t, y) with y (12).
struct Kernel {
  const char* name;
  End (*simulate)(const Run& run);
  Outcome (*control_loop)(const Loop& loop);
  void (*forward_dynamics)(const States& states);
  void* (*new_equations)(const Machine& machine);
  void (*delete_equations)(void* equations);
  void (*start)(void* equations, double* y);
  void (*rates)(void* equations, double t, const double* y, double* rate);
};

}  // namespace simulation_task
