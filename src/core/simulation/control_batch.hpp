// One run of a sampled controller, with numbers of its own, and the arrays that come back.
#pragma once

#include "simulation/batch.hpp"

namespace flexapod {

/// A sampled controller that is shown all measurements: see simulation_task::Controller.
struct ControllerMatrices {
  Numbers A, B, C, D, limit;

  size_t order() const { return C.size() / 6; }
  void check() const {
    constexpr size_t signals = simulation_task::signals;
    check_size(A, order() * order(), "A"), check_size(B, order() * signals, "B"), check_size(C, 6 * order(), "C");
    check_size(D, 6 * signals, "D"), check_size(limit, 6, "limit");
  }
};

/// Rows at every step's end from t = 0, NaN after an early end: measurements without noise, absolute displacement. Rows
/// for every sample: forces, and whether one was cut off (0 or 1).
struct ControlRecord {
  Array<double> measured, displacement, force, cut;
  Outcome outcome = Outcome::complete;

  ControlRecord(size_t samples, size_t steps)
      : measured({samples * steps + 1, simulation_task::signals}, nan),
        displacement({samples * steps + 1, 6}, nan),
        force({samples, 6}, nan),
        cut({samples}, 0.0) {}

 private:
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
};

/// The samples of one run: as many as there are rows of `noise`.
class ControlRun {
 public:
  ControlRecord record;

  ControlRun(const simulation_task::Kernel& kernel, const SimulationSetup& setup, const ControllerMatrices& controller,
             std::span<const double> noise, double dt, size_t steps)
      : record(noise.size() / simulation_task::signals, steps),
        kernel_(kernel),
        machine_(setup.machine()),
        controller_{controller.order(),  controller.A.data(), controller.B.data(),
                    controller.C.data(), controller.D.data(), controller.limit.data()},
        timing_{dt, noise.size() / simulation_task::signals, steps},
        noise_(noise.data()) {}

  void run(const std::atomic<bool>& stop) {
    const simulation_task::Record rows{record.measured.data(), record.displacement.data(), record.force.data(),
                                       record.cut.data()};
    record.outcome = kernel_.control_loop({machine_, controller_, timing_, noise_, rows, &stop, &done_});
  }
  double done() const { return done_; }

 private:
  const simulation_task::Kernel& kernel_;
  simulation_task::Machine machine_;
  simulation_task::Controller controller_;
  simulation_task::Timing timing_;
  const double* noise_;
  std::atomic<double> done_{0.0};
};

}  // namespace flexapod
