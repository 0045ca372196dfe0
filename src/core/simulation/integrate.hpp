// One step of the Runge-Kutta method of order 8 (dop853.hpp) on N numbers, with its error and its interpolant.
//
// Stages are stored one after another and the sums run over N innermost, so that they vectorise.
#pragma once

#include <array>
#include <cmath>

#include "simulation/dop853.hpp"

namespace flexapod {

template <int N> class RungeKutta8 {
 public:
  using State = std::array<double, N>;

  double t = 0, h = 0;  // the step's start and length
  State y0{}, y1{};     // at its two ends

  /// The next step starts at `start` with y. `f(stage, t, y, rate)` writes the rates.
  template <class F> void begin(double start, const State& y, F&& f) {
    t = start, y0 = y;
    f(0, t, y0, k_[0]);
  }
  /// Tries a step of this length.
  template <class F> void attempt(double length, F&& f) {
    h = length;
    State y;
    for (int i = 1; i < dop853::stages; ++i) {
      combine(dop853::a[i], i, y);
      f(i, t + dop853::c[i] * h, y, k_[i]);
    }
    combine(dop853::a[dop853::stages], dop853::stages, y1);
    dense_ = false;
  }
  /// Closes the step tried last with the rates at its end; it can be looked into until `advance`.
  template <class F> void accept(F&& f) { f(dop853::stages, t + h, y1, k_[dop853::stages]); }
  const State& rate() const { return k_[0]; }  // where the step starts
  void advance() { t += h, y0 = y1, k_[0] = k_[dop853::stages]; }

  /// Root mean square over the first `count` numbers of the error, each over its scale (Hairer's mean of orders 5 and 3).
  double error(const State& scale, int count) const {
    double five = 0, three = 0;
    for (int n = 0; n < count; ++n) {
      double e5 = 0, e3 = 0;
      for (int j = 0; j < dop853::stages; ++j) e5 += dop853::e5[j] * k_[j][n], e3 += dop853::e3[j] * k_[j][n];
      five += std::pow(e5 / scale[n], 2), three += std::pow(e3 / scale[n], 2);
    }
    if (five == 0 && three == 0) return 0;
    return std::abs(h) * five / std::sqrt(count * (five + 0.01 * three));
  }

  /// The solution inside the step accepted last, of order 7; the three extra stages are worked out when first needed.
  template <class F> State inside(double time, F&& f) {
    if (!dense_) prepare(f);
    const double x = (time - t) / h;
    State y{};
    for (int i = 6; i >= 0; --i) {
      const double factor = i % 2 == 0 ? x : 1.0 - x;
      for (int n = 0; n < N; ++n) y[n] = (y[n] + terms_[i][n]) * factor;
    }
    for (int n = 0; n < N; ++n) y[n] += y0[n];
    return y;
  }

 private:
  void combine(const double* a, int count, State& y) const {
    State sum{};
    for (int j = 0; j < count; ++j)
      if (a[j] != 0.0)
        for (int n = 0; n < N; ++n) sum[n] += a[j] * k_[j][n];
    for (int n = 0; n < N; ++n) y[n] = y0[n] + h * sum[n];
  }
  template <class F> void prepare(F&& f) {
    for (int i = dop853::stages + 1; i < dop853::extended; ++i) {
      State y;
      combine(dop853::a[i], i, y);
      f(i, t + dop853::c[i] * h, y, k_[i]);
    }
    const State &f0 = k_[0], &f1 = k_[dop853::stages];
    for (int n = 0; n < N; ++n) {
      const double change = y1[n] - y0[n];
      terms_[0][n] = change;
      terms_[1][n] = h * f0[n] - change;
      terms_[2][n] = 2.0 * change - h * (f1[n] + f0[n]);
      for (int i = 0; i < 4; ++i) {
        double sum = 0;
        for (int j = 0; j < dop853::extended; ++j) sum += dop853::d[i][j] * k_[j][n];
        terms_[3 + i][n] = h * sum;
      }
    }
    dense_ = true;
  }

  State k_[dop853::extended], terms_[7];
  bool dense_ = false;
};

}  // namespace flexapod
