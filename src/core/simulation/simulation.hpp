// One simulation from start to end: step size, corners of the excitations, samples, and what may stop it.
#pragma once

#include <atomic>

#include "model/modes.hpp"
#include "simulation/machine_on_base.hpp"
#include "simulation/task.hpp"

namespace flexapod {

using simulation_task::Options;
using simulation_task::Outcome;
using simulation_task::Samples;

struct Counts {
  double accepted = 0, rejected = 0, evaluations = 0;
};

/// Determinant of H with moments taken per length, by elimination with pivoting.
inline double scaled_determinant(Mat6<double> m, double length) {
  for (int i = 3; i < 6; ++i)
    for (int j = 0; j < 6; ++j) m[i][j] /= length;
  double product = 1.0;
  for (int k = 0; k < 6; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 6; ++i)
      if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
    if (m[pivot][k] == 0.0) return 0.0;
    if (pivot != k) std::swap(m.a[k], m.a[pivot]), product = -product;
    product *= m[k][k];
    for (int i = k + 1; i < 6; ++i) {
      const double factor = m[i][k] / m[k][k];
      for (int j = k + 1; j < 6; ++j) m[i][j] -= factor * m[k][j];
    }
  }
  return product;
}

class Simulation {
 public:
  using State = MachineOnBase::State;

  Simulation(const MachineOnBaseInput& input, const Excitation& base, const Excitation& wrench,
             const Excitation& command, const Options& options)
      : machine_(input, base, wrench, command), options_(options), size_(largest_radius(input.design)) {
    const Modes modes =
        natural_modes(machine_.machine(), machine_.geometry(State{}), machine_.rest().R, Mat3<double>::identity());
    slowest_ = modes.omega[0], fastest_ = modes.omega[5];
    double spacing = std::numeric_limits<double>::infinity();
    for (const Excitation* e : {&base, &wrench, &command}) e->notes(corners_, spacing);
    // A step of 6 / omega is where the method stops being stable, and twelve stages see every piece of eight.
    max_step_ = std::min({options_.max_step, 6.0 / fastest_, 8.0 * spacing});
    if (!(options_.atol > 0)) options_.atol = 1e-16 * size_;
  }

  Outcome run(const Samples& samples, const std::atomic<bool>& stop, std::atomic<double>& progress) {
    samples_ = samples;
    const double end = samples.count ? samples.times[samples.count - 1] : 0.0;
    std::erase_if(corners_, [&](double t) { return !(t > 0.0 && t < end); });
    corners_.push_back(end);
    std::sort(corners_.begin(), corners_.end());
    State y = machine_.start();
    machine_.inside = 0.5 * corners_.front();
    watch_from(y);
    double t = 0.0;
    next_step_ = first_step(end);
    sample_until(0.0, [&](double) { return y; });
    for (const double corner : corners_) {
      if (!(corner > t)) continue;
      machine_.inside = 0.5 * (t + corner);
      const Outcome outcome = go(t, corner, y, stop, progress);
      if (outcome != Outcome::complete) return outcome;
      t = corner, y = rk_.y0;
    }
    progress = 1.0;
    return Outcome::complete;
  }

  double time() const { return time_; }  // reached
  const Counts& counts() const { return counts_; }
  /// The platform where the run ended, inertial axes.
  Motion<double> last() {
    Motion<double> platform, base;
    Vec6<double> leg_force;
    machine_.motions(time_, last_, platform, base, leg_force);
    return platform;
  }

 private:
  using Method = RungeKutta8<16>;
  static constexpr double collapsed = 1e-3;  // length of a leg over the platform's size at which its joints meet

  auto rates() {
    return [this](int stage, double t, const State& y, State& rate) {
      counts_.evaluations += 1;
      machine_.rates(t, y, rate, stage == 0 || stage > 4);  // works take no part in stages 1 to 4
    };
  }

  double first_step(double end) const {
    const double step = fastest_ > 0 ? 0.1 / fastest_ : end;
    return std::min({step, 1e-3 * end, max_step_});
  }

  /// From t to the next corner.
  Outcome go(double t, double corner, const State& start, const std::atomic<bool>& stop,
             std::atomic<double>& progress) {
    const auto f = rates();
    rk_.begin(t, start, f);
    peaks_ = peaks_with(start, 0.0);
    bool rejected = false;
    const double end = corners_.back();
    while (rk_.t < corner) {
      if (stop.load(std::memory_order_relaxed)) return Outcome::stopped;
      if (counts_.accepted + counts_.rejected >= options_.max_steps) return ended(Outcome::max_steps);
      const double left = corner - rk_.t;
      const bool last = next_step_ >= left * (1.0 - 1e-12);
      const double h = last ? left : next_step_ > 0.5 * left ? 0.5 * left : next_step_;
      if (h < 1e-14 * std::max(rk_.t, 1e-3 * end)) return ended(collapse());
      rk_.attempt(h, f);
      const double error = rk_.error(scales(peaks_with(rk_.y1, h)), MachineOnBase::mechanical);
      if (!(error <= 1.0)) {
        counts_.rejected += 1, rejected = true;
        next_step_ = h * (error > 1.0 ? std::max(0.2, 0.9 * std::pow(error, -0.125)) : 0.2);  // 0.2 too for NaN
        continue;
      }
      counts_.accepted += 1;
      rk_.accept(f);
      const Outcome outcome = look(f);
      if (outcome != Outcome::complete) return outcome;
      // Proportional-integral control (Hairer and Wanner II, IV.2): a fast mode's phase makes the error go up and down.
      const double growth = std::clamp(0.93 * std::pow(error, -0.7 / 8) * std::pow(last_error_, 0.4 / 8), 0.3, 6.0);
      last_error_ = std::max(error, 1e-4);
      const double proposed = h * (rejected ? std::min(1.0, growth) : growth);
      next_step_ = std::min(h < next_step_ ? std::max(proposed, next_step_) : proposed, max_step_);
      rejected = false;
      step_on(last ? corner : rk_.t + h, f);
      progress.store(rk_.t / end, std::memory_order_relaxed);
    }
    return Outcome::complete;
  }

  /// Goes to the next step, with the error's scales and the chart brought up to date.
  template <class F> void step_on(double t, F&& f) {
    const double h = rk_.h;
    rk_.advance();
    rk_.t = t;  // exactly at a corner
    time_ = t, last_ = rk_.y0;
    peaks_ = peaks_with(rk_.y0, h);
    if (machine_.recentre(rk_.y0)) rk_.begin(t, State(rk_.y0), f);
  }

  /// Largest displacement and speed of the last few periods of the slowest mode, rotations counted at the platform's
  /// size. Errors are measured against them, so that a vibration's passage through zero asks for nothing special.
  struct Peaks {
    double displacement = 0, speed = 0;
  };
  Peaks peaks_with(const State& y, double h) const {
    const auto length = [&](int i) { return std::sqrt(y[i] * y[i] + y[i + 1] * y[i + 1] + y[i + 2] * y[i + 2]); };
    const double kept = std::exp(-0.2 * slowest_ * h);
    return {std::max({kept * peaks_.displacement, length(0), size_ * length(3)}),
            std::max({kept * peaks_.speed, length(6), size_ * length(9)})};
  }
  State scales(const Peaks& peaks) const {
    const double d = options_.atol + options_.rtol * peaks.displacement;
    const double v = options_.atol * std::max(fastest_, 1.0) + options_.rtol * peaks.speed;
    State scale{};
    for (int i = 0; i < 3; ++i) scale[i] = d, scale[3 + i] = d / size_, scale[6 + i] = v, scale[9 + i] = v / size_;
    return scale;
  }

  /// Takes the samples of the step just accepted, up to where something in it ends the run.
  template <class F> Outcome look(F&& f) {
    const double end = rk_.t + rk_.h;
    const auto inside = [&](double t) { return t == end ? rk_.y1 : rk_.inside(t, f); };
    const Geometry<double> g = machine_.geometry(rk_.y1);
    const double side = determinant(g);
    Outcome outcome = Outcome::complete;
    double until = end;
    for (int i = 0; i < 6; ++i) {
      if (dot(g.S[i], S_[i]) > 0) continue;
      const auto length = [&](double t) { return norm(machine_.geometry(inside(t)).S[i]); };
      const double nearest = where_least(length, rk_.t, end);
      if (length(nearest) < collapsed * size_) outcome = Outcome::leg_collapsed, until = std::min(until, nearest);
    }
    if (outcome == Outcome::complete && options_.stop_at_singular && side * side_ <= 0) {
      outcome = Outcome::singular;
      until = last_of_side(inside);
    }
    sample_until(until, inside);
    side_ = side;
    std::copy(g.S, g.S + 6, S_);
    if (outcome != Outcome::complete) time_ = until, last_ = inside(until);
    return outcome;
  }

  /// The last instant of the step on the side of the singular poses where it began.
  template <class G> double last_of_side(G&& inside) const {
    double low = rk_.t, high = rk_.t + rk_.h;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (determinant(machine_.geometry(inside(middle))) * side_ > 0 ? low : high) = middle;
    }
    return low;
  }
  /// Where a function is least between two instants: a scan, then thirds.
  template <class G> static double where_least(G&& value, double low, double high) {
    constexpr int parts = 32;
    const double width = (high - low) / parts;
    int best = 0;
    for (int i = 1; i <= parts; ++i)
      if (value(low + i * width) < value(low + best * width)) best = i;
    double a = low + std::max(best - 1, 0) * width, b = low + std::min(best + 1, parts) * width;
    for (int i = 0; i < 80; ++i) {
      const double third = (b - a) / 3.0;
      if (value(a + third) < value(b - third)) b -= third;
      else a += third;
    }
    return 0.5 * (a + b);
  }

  double determinant(const Geometry<double>& g) const { return scaled_determinant(force_transformation(g), size_); }

  void watch_from(const State& y) {
    const Geometry<double> g = machine_.geometry(y);
    side_ = determinant(g), last_ = y, time_ = 0.0;
    std::copy(g.S, g.S + 6, S_);
  }

  Outcome ended(Outcome why) {
    time_ = rk_.t, last_ = rk_.y0;
    return why;
  }
  /// Why steps have become too small.
  Outcome collapse() {
    State rate;
    machine_.rates(rk_.t, rk_.y0, rate, false);
    const Geometry<double> g = machine_.geometry(rk_.y0);
    for (int i = 0; i < 6; ++i) {
      const double L = norm(g.S[i]);
      if (L < 10.0 * collapsed * size_) return Outcome::leg_collapsed;
      if (norm(cross(g.k[i], g.S[i])) < 1e-2 * L) return Outcome::joint_locked;
    }
    if (machine_.outside_law(rk_.t + 100.0 * next_step_)) return Outcome::outside_stiffness_law;
    const bool finite = std::all_of(rate.begin(), rate.end(), [](double x) { return std::isfinite(x); });
    return finite ? Outcome::step_collapse : Outcome::not_finite;
  }

  template <class G> void sample_until(double t, G&& state) {
    for (; next_sample_ < samples_.count && samples_.times[next_sample_] <= t; ++next_sample_) {
      const double at = samples_.times[next_sample_];
      const State y = state(at);
      const Vec6<double> x = machine_.displacement(at, y);
      std::copy_n(x.a, 6, samples_.displacement + 6 * next_sample_);
      std::copy_n(machine_.relative(y).a, 6, samples_.relative + 6 * next_sample_);
      std::copy_n(y.data() + MachineOnBase::mechanical, 4, samples_.work + 4 * next_sample_);
      if (!samples_.platform) continue;
      auto* platform = reinterpret_cast<Motion<double>*>(samples_.platform) + next_sample_;
      auto* base = reinterpret_cast<Motion<double>*>(samples_.base) + next_sample_;
      auto* leg_force = reinterpret_cast<Vec6<double>*>(samples_.leg_force) + next_sample_;
      machine_.motions(at, y, *platform, *base, *leg_force);
    }
  }

  MachineOnBase machine_;
  Options options_;
  Method rk_;
  Samples samples_{};
  Counts counts_;
  List<double> corners_;
  State last_{};
  double size_, slowest_, fastest_, max_step_, next_step_ = 0, time_ = 0;
  Peaks peaks_;
  double last_error_ = 1.0;
  double side_ = 0;    // sign of det H
  Vec3<double> S_[6];  // legs at the end of the last step
  size_t next_sample_ = 0;
};

}  // namespace flexapod
