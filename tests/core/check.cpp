// The core without Python, for compilers and processors that the tests do not run on: reads a machine and its motions as
// raw doubles, writes what the lanes of this build make of them. See compare.py.
#include <cstdio>
#include <limits>
#include <memory>
#include <vector>

#include "simulation/six_legs.hpp"
#include "sweep/task.hpp"

namespace flexapod {
extern const sweep_task::Kernel sweep_kernel;
}

namespace {

using namespace flexapod;

std::vector<double> read() {
  std::vector<double> numbers(1);
  while (std::fread(&numbers.back(), sizeof(double), 1, stdin) == 1) numbers.push_back(0.0);
  numbers.pop_back();
  return numbers;
}

void write(const std::vector<double>& numbers) { std::fwrite(numbers.data(), sizeof(double), numbers.size(), stdout); }

/// Limits that some poses keep and others do not; compare.py has the same.
sweep_task::Limits some_limits() {
  sweep_task::Limits limits{};
  for (auto& side : limits.neutral)
    for (auto& direction : side) direction[2] = 1.0;
  for (auto& length : limits.length) length[1] = 1.0;
  limits.universal_angle = limits.spherical_angle = 0.5, limits.leg_distance = 0.01;
  limits.universal_moment = limits.spherical_moment = std::numeric_limits<double>::infinity();
  return limits;
}

void sweep(const double* design, const double* poses, std::size_t n) {
  std::vector<double> omega(6 * n), cond(n), length(6 * n), distance(n), force(n), stiffness(n);
  std::vector<double> universal(6 * n), spherical(6 * n), gradient(6 * n), lowest(n);
  std::vector<std::uint8_t> status(n);
  const std::unique_ptr<bool[]> within(new bool[n]);
  const sweep_task::Limits limits = some_limits();
  sweep_task::Task task{};
  task.design = design, task.joint = Joint::universal, task.quantities = 1023;
  task.poses = {poses, poses + 3, 6, 6, 3}, task.limits = &limits;
  task.omega_1_ = lowest.data(), task.omega_ = omega.data(), task.cond_H_ = cond.data();
  task.leg_length_ = length.data(), task.leg_distance_ = distance.data(), task.leg_force_ = force.data();
  task.lowest_stiffness_ = stiffness.data(), task.universal_angle_ = universal.data();
  task.spherical_angle_ = spherical.data(), task.omega_1_gradient_ = gradient.data();
  task.within_limits_ = within.get(), task.status_ = status.data();
  sweep_kernel.sweep(task, 0, n);
  for (const auto* result : {&omega, &cond, &length, &distance, &force, &stiffness, &universal, &spherical, &gradient})
    write(*result);
  write({status.begin(), status.end()});
  write({within.get(), within.get() + n});
}

/// With a load, so that no acceleration is zero but for rounding; compare.py has the same.
void dynamics(const Design<double>& design, const Motion<double>* platform, std::size_t n) {
  const Machine<double> machine(design, Joint::universal);
  const SixLegs legs(machine);
  const Vec6<double> load = Vec6<double>::of({1.0, 1.0, 1.0}, {1.0, 1.0, 1.0});
  for (std::size_t i = 0; i < n; ++i) {
    const Vec6<double> wrench = external_wrench(platform[i].pose.R, load);
    const Vec6<double> a = forward_dynamics(legs, platform[i], Motion<double>(), Vec6<double>(), wrench);
    write({a.a, a.a + 6});
  }
}

}  // namespace

int main() {
  const std::vector<double> numbers = read();
  const std::size_t n = (numbers.size() - design_size) / (6 + motion_size);
  const double* design = numbers.data();
  const double* poses = design + design_size;
  sweep(design, poses, n);
  dynamics(*reinterpret_cast<const Design<double>*>(design), reinterpret_cast<const Motion<double>*>(poses + 6 * n), n);
  std::fprintf(stderr, "%d lanes in a vector\n", Lanes::lanes);
}
