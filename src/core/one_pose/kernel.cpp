// Questions at one pose for one instruction set, compiled as sweep/kernel.cpp is.
#include "decomposition/singular_lanes.hpp"
#include "model/modes.hpp"
#include "one_pose/tangent.hpp"
#include "one_pose/task.hpp"

namespace flexapod {
namespace {

using one_pose_task::Matrices;
using one_pose_task::State;

const MachineAtPose& machine_at(const void* machine) { return *static_cast<const MachineAtPose*>(machine); }
const Motion<double>& motion(const double* numbers) { return *reinterpret_cast<const Motion<double>*>(numbers); }
const Vec6<double>& vec6(const double* numbers) { return *reinterpret_cast<const Vec6<double>*>(numbers); }

void* new_machine(const double* design, Joint joint) {
  return new MachineAtPose(*reinterpret_cast<const Design<double>*>(design), joint);
}
void delete_machine(void* machine) { delete static_cast<MachineAtPose*>(machine); }

/// B = L^-1 F of the springs along the legs.
FLEXAPOD_FLAT SpringMatrix<double> scaled_springs(const MachineAtPose& m, const Pose<double>& platform,
                                                  const Pose<double>& base) {
  const LegPlaces places(m.legs, platform, base);
  SpatialInertia<Lanes> J{};
  Mat6<double> H;
  PerLeg length;
  for (int g = 0; g < leg_groups; ++g) {
    const GroupPlaces& at = places.group[g];
    const LegAxes<Lanes> leg(at.S, at.k, m.legs.joint);
    add_leg_inertia(J, leg, m.legs.group[g].inertia, at.q_p);
    set_force_transformation(H, g, at, leg);
    length.group[g] = leg.L;
  }
  const Vec6<double> L = length.six();
  SpringMatrix<double> B;
  for (int j = 0; j < 6; ++j) {
    const double root = std::sqrt(m.machine.stiffness(j, L[j]));
    for (int r = 0; r < 6; ++r) B[r][j] = root * H[r][j];
  }
  Cholesky<double>(inertia(m.legs.design, platform.R, J)).forward_all(B);
  return B;
}

template <Wanted wanted> void frequencies_along(const MachineAtPose& m, const State& at, int count, double* omega) {
  const SpringMatrix<double> B = scaled_springs(m, motion(at.platform).pose, motion(at.base).pose);
  const auto [share, sum] = singular_squares<wanted, double>([&] { return B; });
  for (int i = 0; i < count; ++i) omega[i] = sum < 1e300 ? std::sqrt(sum * share[i]) : NAN;
}

void frequencies(const void* machine, const State& at, int count, double* omega) {
  const MachineAtPose& m = machine_at(machine);
  if (m.machine.features.others()) {
    const Pose<double>&platform = motion(at.platform).pose, &base = motion(at.base).pose;
    const Modes modes =
        natural_modes(m.machine, Geometry<double>(m.machine.design, platform, base), platform.R, base.R);
    std::copy_n(modes.omega, count, omega);
  } else if (count == 1) {
    frequencies_along<Wanted::lowest>(m, at, 1, omega);
  } else {
    frequencies_along<Wanted::all>(m, at, 6, omega);
  }
}

void accelerations(const void* machine, const State& at, const double* leg_force, const double* wrench,
                   double* acceleration) {
  const Motion<double>& platform = motion(at.platform);
  const Vec6<double> found = forward_dynamics(machine_at(machine).legs, platform, motion(at.base), vec6(leg_force),
                                              external_wrench(platform.pose.R, vec6(wrench)));
  std::copy_n(found.a, 6, acceleration);
}

void leg_forces(const void* machine, const State& at, const double* wrench, double* force) {
  const Motion<double>& platform = motion(at.platform);
  const Vec6<double> found = inverse_dynamics(machine_at(machine).legs, platform, motion(at.base),
                                              external_wrench(platform.pose.R, vec6(wrench)));
  std::copy_n(found.a, 6, force);
}

void tangent(const void* machine, const State& at, const double* wrench, const double* force, const double* stiffness,
             const Matrices& to) {
  TangentAtRest of(machine_at(machine), motion(at.platform).pose, motion(at.base).pose, vec6(wrench), to);
  of.set_stiffness(vec6(force), vec6(stiffness));
  of.set_base(to);
}

void linearised(const void* machine, const State& at, const double* wrench, const Matrices& to) {
  const Machine<double>& m = machine_at(machine).machine;
  TangentAtRest of(machine_at(machine), motion(at.platform).pose, motion(at.base).pose, vec6(wrench), to);
  const Vec6<double> force = of.leg_forces();
  if (m.features.law == Law::constant) return of.set_stiffness(force, vec6(m.axial.constant));
  const Vec6<double> length = of.leg_lengths();
  Vec6<double> stiffness;
  for (int i = 0; i < 6; ++i) stiffness[i] = m.stiffness(i, unstretched_length(m, i, length[i], force[i]));
  of.set_stiffness(force, stiffness);
}

}  // namespace

extern const one_pose_task::Kernel one_pose_kernel;
const one_pose_task::Kernel one_pose_kernel = {FLEXAPOD_ISA,   &new_machine, &delete_machine, &frequencies,
                                               &accelerations, &leg_forces,  &tangent,        &linearised};

}  // namespace flexapod
