// The complete machine under a sampled linear controller: between samples the leg forces are held.
#pragma once

#include "simulation/simulation.hpp"

namespace flexapod {

/// x[k+1] = A x + B (y + noise), f = C x + D (y + noise), clipped to +-limit; y is MachineOnBase::measure at the sample.
struct SampledController : simulation_task::Controller {
  static constexpr int signals = simulation_task::signals;

  /// The forces for a measurement; true where a limit cut one off.
  bool update(const double (&y)[signals], List<double>& x, Vec6<double>& f) const {
    bool cut = false;
    for (int i = 0; i < 6; ++i) {
      f[i] = product(C + i * order, x.data(), order) + product(D + i * signals, y, signals);
      const double clipped = std::clamp(f[i], -limit[i], limit[i]);
      cut = cut || clipped != f[i];
      f[i] = clipped;
    }
    List<double> next(order);
    for (size_t i = 0; i < order; ++i)
      next[i] = product(A + i * order, x.data(), order) + product(B + i * signals, y, signals);
    x.swap(next);
    return cut;
  }

 private:
  static double product(const double* row, const double* v, size_t n) {
    double sum = 0;
    for (size_t j = 0; j < n; ++j) sum += row[j] * v[j];
    return sum;
  }
};

/// Samples `count` times, `dt` apart, from t = 0; each sample's interval is `steps` equal steps of order 8 (more where an
/// excitation has a corner).
class ControlLoop {
 public:
  using Timing = simulation_task::Timing;
  using Record = simulation_task::Record;

  ControlLoop(const MachineOnBaseInput& input, const Excitation& base, const SampledController& controller,
              const Timing& timing)
      : machine_(input, base, none_, none_), controller_(controller), timing_(timing), x_(controller.order) {
    double spacing = 0;
    base.notes(corners_, spacing);
    std::erase_if(corners_, [](double t) { return !(t > 0 && std::isfinite(t)); });
    std::sort(corners_.begin(), corners_.end());
  }

  /// noise: rows of 36 for every sample. Ends early where a number is no longer finite or H becomes singular.
  Outcome run(const double* noise, const Record& record, const std::atomic<bool>& stop, std::atomic<double>& progress) {
    State y = machine_.start();
    double side = determinant(y);
    for (size_t k = 0; k < timing_.count; ++k) {
      if (stop.load(std::memory_order_relaxed)) return Outcome::stopped;
      const double t = timing_.dt * static_cast<double>(k);
      machine_.inside = t + 1e-6 * timing_.dt;
      if (k == 0) write_row(record, 0, t, y);
      sample(noise + k * SampledController::signals, t, y, record.force + 6 * k, record.cut[k]);
      for (size_t step = 0; step < timing_.steps; ++step) {
        const double h = timing_.dt / static_cast<double>(timing_.steps);
        const double from = t + h * static_cast<double>(step);
        advance(y, from, from + h);
        if (!std::all_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); })) return Outcome::not_finite;
        const double now = determinant(y);
        if (!(now * side > 0)) return Outcome::singular;
        side = now;
        write_row(record, k * timing_.steps + step + 1, from + h, y);
      }
      progress.store(static_cast<double>(k + 1) / static_cast<double>(timing_.count), std::memory_order_relaxed);
    }
    return Outcome::complete;
  }

 private:
  using State = MachineOnBase::State;

  void sample(const double* noise, double t, const State& y, double* force, double& cut) {
    double signal[SampledController::signals];
    machine_.measure(t, y, signal);
    for (int i = 0; i < SampledController::signals; ++i) signal[i] += noise[i];
    Vec6<double> f;
    cut = controller_.update(signal, x_, f) ? 1.0 : 0.0;
    machine_.held = PerLeg(f);
    std::copy_n(f.a, 6, force);
  }

  /// From one instant to another, split at the excitation's corners.
  void advance(State& y, double from, double to) {
    const auto f = [this](int, double t, const State& state, State& rate) { machine_.rates(t, state, rate, false); };
    for (double t = from; t < to;) {
      while (next_corner_ < corners_.size() && corners_[next_corner_] <= t) ++next_corner_;
      double end = to;
      if (next_corner_ < corners_.size() && corners_[next_corner_] < to) end = corners_[next_corner_];
      machine_.inside = 0.5 * (t + end);
      method_.begin(t, y, f);
      method_.attempt(end - t, f);
      y = method_.y1;
      machine_.recentre(y);
      t = end;
    }
  }

  void write_row(const Record& record, size_t row, double t, const State& y) {
    double signal[SampledController::signals];
    machine_.measure(t, y, signal);
    std::copy_n(signal, SampledController::signals, record.measured + row * SampledController::signals);
    const Vec6<double> x = machine_.displacement(t, y);
    std::copy_n(x.a, 6, record.displacement + 6 * row);
  }
  double determinant(const State& y) const {
    return scaled_determinant(force_transformation(machine_.geometry(y)), 1.0);
  }

  const Excitation none_{nullptr, 0};
  MachineOnBase machine_;
  SampledController controller_;
  Timing timing_;
  RungeKutta8<16> method_;
  List<double> x_, corners_;
  size_t next_corner_ = 0;
};

}  // namespace flexapod
