// The matrices of exponential Adams steps (exponential_adams.hpp): the linear part's solution over one step, and what it makes
// of polynomials that drive it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "simd/pack.hpp"

namespace flexapod {

namespace exponential {

inline constexpr int min_order = 4, max_order = 11, differences = max_order + 2, max_terms = 40;

/// Numbers that hold for every A and h.
struct Weights {
  double c[differences][differences] = {};  // c_j(theta) = sum_i c[j][i] theta^i
  double w[max_terms][differences] = {};    // int_0^1 (1 - theta)^m / m! c_j(theta) dtheta

  constexpr Weights() {
    c[0][0] = 1.0;
    for (int j = 0; j + 1 < differences; ++j)
      for (int i = 0; i <= j; ++i) c[j + 1][i] += c[j][i] * j / (j + 1), c[j + 1][i + 1] += c[j][i] / (j + 1);
    for (int m = 0; m < max_terms; ++m) {
      double beta = 1.0;  // i! / (m + i + 1)!
      for (int n = 2; n <= m + 1; ++n) beta /= n;
      for (int i = 0; i < differences; ++i) {
        for (int j = i; j < differences; ++j) w[m][j] += c[j][i] * beta;
        beta *= (i + 1.0) / (m + i + 2.0);
      }
    }
  }
};
inline constexpr Weights weights;

/// Twelve numbers in hardware vectors.
struct Twelve {
  using Lanes = Pack<Vector, 1>;
  static constexpr int parts = (12 + Lanes::lanes - 1) / Lanes::lanes;
  Lanes part[parts];

  static FLEXAPOD_INLINE Twelve load(const double* from) {
    Twelve x;
    for (int p = 0; p < parts; ++p) x.part[p] = Lanes::load(from + p * Lanes::lanes);
    return x;
  }
  static FLEXAPOD_INLINE Twelve zero() {
    Twelve x;
    for (Lanes& part : x.part) part = Lanes(0.0);
    return x;
  }
  FLEXAPOD_INLINE void store(double* to) const {
    for (int p = 0; p < parts; ++p) part[p].store(to + p * Lanes::lanes);
  }
  FLEXAPOD_INLINE void add(const Twelve& b, double factor) {
    const Lanes all(factor);
    for (int p = 0; p < parts; ++p) part[p] += b.part[p] * all;
  }
  friend FLEXAPOD_INLINE Twelve operator+(Twelve a, const Twelve& b) {
    for (int p = 0; p < parts; ++p) a.part[p] += b.part[p];
    return a;
  }
  friend FLEXAPOD_INLINE Twelve operator-(Twelve a, const Twelve& b) {
    for (int p = 0; p < parts; ++p) a.part[p] -= b.part[p];
    return a;
  }
};

/// Three sums side by side, which hide the latency of the additions.
struct Sums {
  Twelve part[3] = {Twelve::zero(), Twelve::zero(), Twelve::zero()};

  template <int columns> FLEXAPOD_INLINE void add(const Twelve (&matrix)[columns], const double* x) {
    static_assert(columns % 3 == 0);
    for (int c = 0; c < columns; c += 3)
      for (int i = 0; i < 3; ++i) part[i].add(matrix[c + i], x[c + i]);
  }
  FLEXAPOD_INLINE Twelve total() const { return part[0] + part[1] + part[2]; }
};

/// E and B_j for one A and one step.
struct Propagator {
  static constexpr int driven = 9;  // g acts on the last nine numbers: its first three are zero
  double h = 0;
  int terms = 0;  // of the Taylor series
  Twelve E[12], B[differences][driven];

  /// False where the series does not converge soon. `unit`: the sizes of the twelve numbers against each other.
  bool set(const Twelve (&A)[12], double step, const double (&unit)[16]) {
    h = step;
    double power[12][16] = {};  // columns of (h A)^m
    double factorial = 1.0;
    for (int c = 0; c < 12; ++c) power[c][c] = 1.0, E[c] = Twelve::load(power[c]);
    for (auto& columns : B)
      for (Twelve& column : columns) column = Twelve::zero();
    for (terms = 0; terms < max_terms; ++terms) {
      for (int j = 0; j < differences; ++j)
        for (int c = 0; c < driven; ++c) B[j][c].add(Twelve::load(power[c + 3]), h * weights.w[terms][j]);
      factorial /= terms + 1;
      for (int c = 0; c < 12; ++c) {
        Sums sums;
        sums.add(A, power[c]);
        Twelve column = Twelve::zero();
        column.add(sums.total(), h);
        column.store(power[c]);
        E[c].add(column, factorial);
      }
      if (terms % 4 != 3) continue;
      double largest = 0;
      for (int c = 0; c < 12; ++c)
        for (int i = 0; i < 12; ++i) largest = std::max(largest, std::abs(power[c][i]) * unit[c] / unit[i]);
      if (!(largest * factorial > 1e-18)) return std::isfinite(largest);
    }
    return false;
  }
};

}  // namespace exponential

}  // namespace flexapod
