// What a machine is asked at one pose and where the answers go: plain data, shared by kernels that are compiled for
// different instruction sets. Nothing here may be a function: it would be shared by them as well.
#pragma once

#include "model/joint.hpp"

namespace one_pose_task {

/// Motions of platform and base, 24 numbers each.
struct State {
  const double *platform, *base;
};

/// Where matrices of linear dynamics go, 36 numbers each; those of the base where they are asked.
struct Matrices {
  double *M, *C, *K, *H, *M_b, *C_b, *K_b;
};

/// A kernel compiled for one instruction set. `machine` is one of its own, made once for a design.
struct Kernel {
  const char* name;
  void* (*new_machine)(const double* design, core_enums::Joint joint);
  void (*delete_machine)(void* machine);
  /// The lowest or all six natural frequencies, rad/s; NaN where there are none.
  void (*frequencies)(const void* machine, const State& at, int count, double* omega);
  /// Six accelerations of the platform for six leg forces and a wrench in the platform's axes.
  void (*accelerations)(const void* machine, const State& at, const double* leg_force, const double* wrench,
                        double* acceleration);
  /// Six leg forces that give the platform's accelerations, for a wrench in its axes; NaN where H is singular.
  void (*leg_forces)(const void* machine, const State& at, const double* wrench, double* force);
  /// All matrices about rest, for a wrench in the platform's axes, the leg forces that hold it and the stiffnesses along
  /// the legs.
  void (*tangent)(const void* machine, const State& at, const double* wrench, const double* force,
                  const double* stiffness, const Matrices& to);
  /// M, C, K and H about rest, for a wrench in the platform's axes.
  void (*linearised)(const void* machine, const State& at, const double* wrench, const Matrices& to);
};

}  // namespace one_pose_task
