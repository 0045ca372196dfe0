// Symmetric matrices of six rows in lanes: definiteness, and splitting into parts that are not negative.
#pragma once

#include "decomposition/svd_jacobi.hpp"

namespace flexapod {

inline constexpr int symmetric_size = 21;

/// The lower triangle by rows.
inline constexpr int entry(int row, int column) {
  return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
}

template <class Lane> using Symmetric6 = Lane[symmetric_size];

/// Whether m is positive definite, proved: all pivots of m less 1e-12 of its trace are positive in floating point, while
/// roundings of an elimination that ends can have changed m by 1e-14 of the trace at most (N. J. Higham, Accuracy and
/// Stability of Numerical Algorithms, theorem 10.3). False for NaN.
template <class Lane> FLEXAPOD_INLINE mask_t<Lane> positive_definite(const Lane (&m)[symmetric_size]) {
  Lane a[symmetric_size], trace = m[0];
  for (int i = 1; i < 6; ++i) trace += m[entry(i, i)];
  const Lane shift = 1e-12 * trace;
  FLEXAPOD_UNROLL
  for (int k = 0; k < symmetric_size; ++k) a[k] = m[k];
  FLEXAPOD_UNROLL
  for (int i = 0; i < 6; ++i) a[entry(i, i)] -= shift;
  auto positive = trace < 1e300;
  FLEXAPOD_UNROLL
  for (int j = 0; j < 6; ++j) {
    const Lane pivot = a[entry(j, j)];
    positive = positive & (pivot > 0.0);
    if (j == 5) break;
    const Lane inverse = 1.0 / pivot;
    FLEXAPOD_UNROLL
    for (int i = j + 1; i < 6; ++i) {
      const Lane factor = a[entry(i, j)] * inverse;
      FLEXAPOD_UNROLL
      for (int k = j + 1; k <= i; ++k) a[entry(i, k)] -= factor * a[entry(k, j)];
    }
  }
  return positive;
}

/// A matrix N that is not negative, and so large that d + N is not negative either: d without its positive part, after
/// a sweep of Jacobi's rotations, with Gershgorin's bound of what they leave. It is near the smallest one; whether d +
/// N is not negative must be looked at.
template <class Lane> void negative_part(const Lane (&d)[symmetric_size], Lane (&N)[symmetric_size]) {
  Lane a[6][6], V[6][6];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) a[i][j] = d[entry(i, j)], V[i][j] = Lane(i == j ? 1.0 : 0.0);
  for (int p = 0; p < 5; ++p)
    for (int q = p + 1; q < 6; ++q) {
      const Lane off = a[p][q];
      const auto open = abs(off) > 1e-280;
      const Lane zeta = (a[q][q] - a[p][p]) / (2.0 * select(open, off, Lane(1.0)));
      const Lane t = select(zeta < 0.0, Lane(-1.0), Lane(1.0)) / (abs(zeta) + sqrt(1.0 + zeta * zeta));
      const Lane c = select(open, rsqrt(1.0 + t * t), Lane(1.0)), s = select(open, c * t, Lane(0.0));
      turn(a[p], a[q], c, s);
      for (int k = 0; k < 6; ++k) {
        const Lane x = a[k][p], y = a[k][q];
        a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
      }
      turn(V[p], V[q], c, s);
    }
  for (int k = 0; k < symmetric_size; ++k) N[k] = Lane(0.0);
  for (int i = 0; i < 6; ++i) {
    Lane least = a[i][i];
    for (int j = 0; j < 6; ++j)
      if (j != i) least -= abs(a[i][j]);
    const Lane weight = max(-least, Lane(0.0));
    for (int r = 0; r < 6; ++r)
      for (int s = 0; s <= r; ++s) N[entry(r, s)] += weight * (V[i][r] * V[i][s]);
  }
}

}  // namespace flexapod
