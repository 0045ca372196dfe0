// What ends a simulation: singular poses passed through, and legs whose joints meet. Looked at after each step.
#pragma once

#include "simulation/machine_on_base.hpp"
#include "simulation/task.hpp"

namespace flexapod {

using simulation_task::Outcome;

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

class PoseWatch {
 public:
  using State = MachineOnBase::State;
  static constexpr double collapsed = 1e-3;  // length of a leg over the platform's size at which its joints meet

  PoseWatch(double size, bool stop_at_singular) : size_(size), stop_at_singular_(stop_at_singular) {}

  /// From here on, in the machine's present chart.
  void begin(const MachineOnBase& machine, const State& y) {
    const Geometry<double> g = machine.geometry(y);
    keep(g, determinant(g), y);
  }
  /// Whether the step from `from` to `end`, where the state is y1, leaves the run as it was; else `until` becomes the instant at
  /// which it ends. `inside` gives the state between.
  template <class G>
  Outcome look(const MachineOnBase& machine, double from, double end, const State& y1, G&& inside, double& until) {
    if (near(y1)) return Outcome::complete;
    const Geometry<double> g = machine.geometry(y1);
    const double side = determinant(g);
    Outcome outcome = Outcome::complete;
    for (int i = 0; i < 6; ++i) {
      if (dot(g.S[i], S_[i]) > 0) continue;
      const auto length = [&](double t) { return norm(machine.geometry(inside(t)).S[i]); };
      const double nearest = where_least(length, from, end);
      if (length(nearest) < collapsed * size_) outcome = Outcome::leg_collapsed, until = std::min(until, nearest);
    }
    if (outcome == Outcome::complete && stop_at_singular_ && side * side_ <= 0) {
      outcome = Outcome::singular;
      until = last_of_side([&](double t) { return determinant(machine.geometry(inside(t))); }, from, end);
    }
    keep(g, side, y1);
    return outcome;
  }

 private:
  /// Whether the platform has moved so little since the last determinant that neither can have happened. Where its joints
  /// have moved by m, columns of H (no longer than sqrt(2)) have changed by no more than delta = m (4 / L + 1 / size), and
  /// their determinant by no more than 6 delta (sqrt(2) + delta)^5.
  bool near(const State& y) const {
    double d = 0, theta = 0;
    for (int i = 0; i < 3; ++i) {
      d += (y[i] - y_[i]) * (y[i] - y_[i]), theta += (y[3 + i] - y_[3 + i]) * (y[3 + i] - y_[3 + i]);
    }
    const double m = std::sqrt(d) + size_ * std::sqrt(theta);
    return m < radius_;
  }
  void keep(const Geometry<double>& g, double side, const State& y) {
    side_ = side, y_ = y;
    std::copy(g.S, g.S + 6, S_);
    double shortest = std::numeric_limits<double>::infinity();
    for (const auto& S : S_) shortest = std::min(shortest, norm(S));
    // With delta < 0.1, 6 (sqrt(2) + 0.1)^5 < 48; a leg's direction turns by less than a right angle.
    radius_ = std::min(0.1, std::abs(side) / 48.0) / (4.0 / shortest + 1.0 / size_);
    if (!(radius_ > 0)) radius_ = 0;
  }
  double determinant(const Geometry<double>& g) const { return scaled_determinant(force_transformation(g), size_); }

  /// The last instant of the step on the side of the singular poses where it began.
  template <class G> double last_of_side(G&& determinant, double low, double high) const {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (determinant(middle) * side_ > 0 ? low : high) = middle;
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

  double size_;
  bool stop_at_singular_;
  double side_ = 0, radius_ = 0;  // the sign of det H; how far joints may move before it is worked out again
  Vec3<double> S_[6];             // legs then
  State y_{};                     // and the state
};

}  // namespace flexapod
