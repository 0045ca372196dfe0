// Simulations with numbers of their own, many at once, and the arrays that come back.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "model/design.hpp"
#include "numbers/array.hpp"
#include "simulation/excitation.hpp"
#include "simulation/task.hpp"

namespace flexapod {

using simulation_task::Outcome;
using Numbers = std::vector<double>;

/// Throws std::invalid_argument, with the name, for numbers that are too few or too many.
inline void check_size(const Numbers& numbers, size_t size, const char* name) {
  if (numbers.size() != size)
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(numbers.size()) + " numbers; " +
                                std::to_string(size) + " are needed");
}

/// A machine at rest on its base and what drives it from t = 0: see simulation_task::Machine.
struct SimulationSetup {
  Numbers design;
  Joint joint;
  Numbers platform, base, leg_force, wrench, displacement, velocity;
  bool roll_pitch_yaw, carried;
  Numbers base_motion, load, command;  // terms of the excitations

  void check() const {
    check_size(design, design_size, "design");
    check_size(platform, pose_size, "platform"), check_size(base, pose_size, "base");
    check_size(leg_force, 6, "leg_force"), check_size(wrench, 6, "wrench");
    check_size(displacement, 6, "displacement"), check_size(velocity, 6, "velocity");
    for (const Numbers* terms : {&base_motion, &load, &command}) Excitation(terms->data(), terms->size());
  }
  /// For a kernel, as long as this lives.
  simulation_task::Machine machine() const {
    const auto series = [](const Numbers& terms) { return simulation_task::Series{terms.data(), terms.size()}; };
    simulation_task::Machine m{};
    m.design = design.data(), m.joint = joint;
    m.roll_pitch_yaw = roll_pitch_yaw, m.carried = carried;
    m.base_motion = series(base_motion), m.load = series(load), m.command = series(command);
    std::copy(platform.begin(), platform.end(), m.platform), std::copy(base.begin(), base.end(), m.base);
    std::copy(leg_force.begin(), leg_force.end(), m.leg_force), std::copy(wrench.begin(), wrench.end(), m.wrench);
    std::copy(displacement.begin(), displacement.end(), m.displacement);
    std::copy(velocity.begin(), velocity.end(), m.velocity);
    return m;
  }
};

/// Rows for n simulations at m instants, NaN after the end of one that was stopped; motions and leg forces have m = 0
/// unless asked for.
struct SimulationResult {
  Array<double> displacement, relative, work, platform, base, leg_force;
  std::vector<Outcome> outcome;
  Array<double> time, last;   // reached, and the platform's motion then
  Array<std::int64_t> steps;  // (n, 4) accepted, rejected, evaluations; exponential ones accepted

  SimulationResult(size_t n, size_t m, size_t kept)
      : displacement({n, m, 6}, nan),
        relative({n, m, 6}, nan),
        work({n, m, 4}, nan),
        platform({n, kept, motion_size}, nan),
        base({n, kept, motion_size}, nan),
        leg_force({n, kept, 6}, nan),
        outcome(n),
        time({n}, nan),
        last({n, motion_size}, nan),
        steps({n, 4}, 0) {}

 private:
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
};

/// Simulations at the same number of instants each, which may run on several threads.
class SimulationBatch {
 public:
  SimulationResult result;

  /// times: (n, m), as long as this lives.
  SimulationBatch(const simulation_task::Kernel& kernel, const std::vector<const SimulationSetup*>& setups,
                  std::span<const double> times, const simulation_task::Options& options)
      : result(setups.size(), times.size() / setups.size(), options.motions ? times.size() / setups.size() : 0),
        kernel_(kernel),
        setups_(setups),
        times_(times.data()),
        instants_(times.size() / setups.size()),
        options_(options),
        done_(setups.size()) {}

  void run(size_t i, const std::atomic<bool>& stop) {
    const auto rows = [&](Array<double>& array, size_t width) {
      return array.size() == 0 ? nullptr : array.data() + i * instants_ * width;
    };
    const simulation_task::Samples samples{times_ + i * instants_,         instants_,
                                           rows(result.displacement, 6),   rows(result.relative, 6),
                                           rows(result.work, 4),           rows(result.platform, motion_size),
                                           rows(result.base, motion_size), rows(result.leg_force, 6)};
    const simulation_task::Machine machine = setups_[i]->machine();
    const simulation_task::End end = kernel_.simulate({machine, options_, samples, &stop, &done_[i]});
    done_[i] = 1.0;
    result.outcome[i] = end.outcome, result.time.data()[i] = end.time;
    std::copy_n(end.last, motion_size, result.last.data() + i * motion_size);
    std::int64_t* steps = result.steps.data() + 4 * i;
    for (const double count : {end.accepted, end.rejected, end.evaluations, end.exponential})
      *steps++ = static_cast<std::int64_t>(count);
  }
  /// The share of the work that is done.
  double done() const {
    double sum = 0;
    for (const auto& part : done_) sum += part;
    return sum / static_cast<double>(done_.size());
  }

 private:
  const simulation_task::Kernel& kernel_;
  std::vector<const SimulationSetup*> setups_;
  const double* times_;
  size_t instants_;
  simulation_task::Options options_;
  std::vector<std::atomic<double>> done_;
};

/// Eq. 35 of one simulation for other integrators: y' = rates(t, y) from y = start().
class Equations {
 public:
  static constexpr size_t size = 12;

  Equations(const simulation_task::Kernel& kernel, const SimulationSetup& setup)
      : kernel_(kernel), setup_(setup), equations_(kernel.new_equations(setup_.machine())) {}
  Equations(const Equations&) = delete;
  Equations& operator=(const Equations&) = delete;
  ~Equations() { kernel_.delete_equations(equations_); }

  Array<double> start() const {
    Array<double> y({size});
    kernel_.start(equations_, y.data());
    return y;
  }
  Array<double> rates(double t, const double* y) const {
    Array<double> rate({size});
    kernel_.rates(equations_, t, y, rate.data());
    return rate;
  }

 private:
  const simulation_task::Kernel& kernel_;
  const SimulationSetup setup_;
  void* equations_;
};

/// Six channels with their first and second derivatives, (n, 3, 6).
inline Array<double> excitation_at(std::span<const double> terms, std::span<const double> times) {
  Excitation e(terms.data(), terms.size());
  Array<double> values({times.size(), 3, 6});
  double* to = values.data();
  for (const double t : times) {
    Jet channel[6];
    e.at(t, t, channel);
    for (const auto part : {&Jet::x, &Jet::v, &Jet::a})
      for (const Jet& jet : channel) *to++ = jet.*part;
  }
  return values;
}

/// Motions of a base that an excitation drives from its pose at rest, (n, motion_size).
inline Array<double> base_motion_at(std::span<const double> terms, bool roll_pitch_yaw, const Pose<double>& rest,
                                    std::span<const double> times) {
  Excitation e(terms.data(), terms.size());
  Array<double> rows({times.size(), motion_size});
  auto* motion = reinterpret_cast<Motion<double>*>(rows.data());
  for (const double t : times) {
    Jet channel[6];
    e.at(t, t, channel);
    *motion++ = BaseMotion(rest, channel, e.uses(3, 6), roll_pitch_yaw).motion;
  }
  return rows;
}

}  // namespace flexapod
