// Simulations and forward dynamics for one instruction set. CMake compiles this file once for each, with `flexapod`
// defined as another name: then no inline function of one can stand in for that of another in the linked module.
#include "simulation/control_loop.hpp"
#include "simulation/simulation.hpp"

namespace flexapod {
namespace {

using namespace simulation_task;

static_assert(sizeof(Pose<double>) == sizeof(simulation_task::Machine::base) &&
              sizeof(Motion<double>) == sizeof(End::last));

const Pose<double>& pose(const double (&numbers)[pose_size]) { return *reinterpret_cast<const Pose<double>*>(numbers); }
const Vec6<double>& vec6(const double (&numbers)[6]) { return *reinterpret_cast<const Vec6<double>*>(numbers); }

MachineOnBaseInput input_of(const simulation_task::Machine& m, bool works) {
  return {*reinterpret_cast<const Design<double>*>(m.design),
          m.joint,
          pose(m.platform),
          pose(m.base),
          vec6(m.leg_force),
          vec6(m.wrench),
          m.roll_pitch_yaw,
          works,
          m.carried,
          vec6(m.displacement),
          vec6(m.velocity)};
}
Excitation excitation(const Series& s) { return {s.numbers, s.size}; }

End simulate(const Run& run) {
  const auto& m = run.machine;
  Simulation simulation(input_of(m, run.options.works), excitation(m.base_motion), excitation(m.load),
                        excitation(m.command), run.options);
  End end{simulation.run(run.samples, *run.stop, *run.progress), simulation.time(), {}, 0, 0, 0, 0};
  const Motion<double> last = simulation.last();
  std::memcpy(end.last, &last, sizeof(end.last));
  const Counts& counts = simulation.counts();
  end.accepted = counts.accepted, end.rejected = counts.rejected, end.evaluations = counts.evaluations;
  end.exponential = counts.exponential;
  return end;
}

Outcome control_loop(const Loop& given) {
  ControlLoop loop(input_of(given.machine, false), excitation(given.machine.base_motion),
                   SampledController{given.controller}, given.timing);
  return loop.run(given.noise, given.record, *given.stop, *given.progress);
}

void forward_dynamics_of(const States& s) {
  const auto& design = *reinterpret_cast<const Design<double>*>(s.design);
  const SixLegs legs(flexapod::Machine<double>(design, s.joint));
  const auto *platform = reinterpret_cast<const Motion<double>*>(s.platform),
             *base = reinterpret_cast<const Motion<double>*>(s.base);
  const auto *force = reinterpret_cast<const Vec6<double>*>(s.leg_force),
             *load = reinterpret_cast<const Vec6<double>*>(s.wrench);
  auto* out = reinterpret_cast<Vec6<double>*>(s.acceleration);
  for (size_t i = 0; i < s.count; ++i)
    out[i] = forward_dynamics(legs, platform[i], base[i], force[i], external_wrench(platform[i].pose.R, load[i]));
}

void* new_equations(const simulation_task::Machine& m) {
  return new MachineOnBase(input_of(m, false), excitation(m.base_motion), excitation(m.load), excitation(m.command));
}
void delete_equations(void* machine) { delete static_cast<MachineOnBase*>(machine); }
void start(void* machine, double* y) {
  std::copy_n(static_cast<MachineOnBase*>(machine)->start().data(), MachineOnBase::mechanical, y);
}
void rates(void* equations, double t, const double* numbers, double* rate) {
  auto* machine = static_cast<MachineOnBase*>(equations);
  MachineOnBase::State y{}, all;
  std::copy_n(numbers, MachineOnBase::mechanical, y.data());
  machine->inside = t;
  machine->rates(t, y, all, false);
  std::copy_n(all.data(), MachineOnBase::mechanical, rate);
}

}  // namespace

extern const Kernel simulation_kernel;
const Kernel simulation_kernel = {FLEXAPOD_ISA,   &simulate,         &control_loop, &forward_dynamics_of,
                                  &new_equations, &delete_equations, &start,        &rates};

}  // namespace flexapod
