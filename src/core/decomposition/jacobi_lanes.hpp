// One-sided Jacobi rotations for lanes: slower than the bidiagonal form, and indifferent to repeated singular values.
#pragma once

#include "numbers/linear6.hpp"
#include "simd/pack.hpp"

namespace flexapod {

/// Turns two rows against each other until they are orthogonal; `turned` tells the lanes that were not.
template <int n, class T, class M> FLEXAPOD_INLINE void orthogonalise(T (&a)[n], T (&b)[n], T& c, T& s, M& turned) {
  T aa = a[0] * a[0], bb = b[0] * b[0], ab = a[0] * b[0];
  for (int k = 1; k < n; ++k) aa += a[k] * a[k], bb += b[k] * b[k], ab += a[k] * b[k];
  const auto open = ab * ab > 1e-32 * (aa * bb);
  const T zeta = (bb - aa) / (2.0 * select(open, ab, T(1.0)));
  const T t = select(zeta < 0.0, T(-1.0), T(1.0)) / (abs(zeta) + sqrt(1.0 + zeta * zeta));
  c = select(open, rsqrt(1.0 + t * t), T(1.0));
  s = select(open, c * t, T(0.0));
  turned = turned | open;
  turn(a, b, c, s);
}

template <int n, class T> FLEXAPOD_INLINE void turn(T (&a)[n], T (&b)[n], const T& c, const T& s) {
  for (int k = 0; k < n; ++k) {
    const T x = a[k], y = b[k];
    a[k] = c * x - s * y;
    b[k] = s * x + c * y;
  }
}

/// Rotates m rows of n until all are orthogonal: their lengths are then the singular values. U, if given, is rotated too.
template <int m, int n, class T> void orthogonalise_rows(T (&rows)[m][n], T (*U)[m]) {
  auto turned = T(0.0) < T(1.0);
  for (int sweep = 0; sweep < 40 && any(turned); ++sweep) {
    turned = T(1.0) < T(0.0);
    for (int p = 0; p < m - 1; ++p)
      for (int q = p + 1; q < m; ++q) {
        T c, s;
        orthogonalise(rows[p], rows[q], c, s, turned);
        if (U != nullptr) turn(U[p], U[q], c, s);
      }
  }
}

template <int n, class T> FLEXAPOD_INLINE T row_square(const T (&a)[n]) {
  T sum = a[0] * a[0];
  for (int k = 1; k < n; ++k) sum += a[k] * a[k];
  return sum;
}

/// The six squared singular values of B, ascending.
template <class T> void squared_singular_values(Mat6<T> B, T (&value)[6]) {
  orthogonalise_rows<6, 6, T>(B.a, nullptr);
  for (int i = 0; i < 6; ++i) value[i] = row_square(B.a[i]);
  for (int last = 5; last > 0; --last)
    for (int i = 0; i < last; ++i) {
      const T low = min(value[i], value[i + 1]), high = max(value[i], value[i + 1]);
      value[i] = low, value[i + 1] = high;
    }
}

/// The least squared singular value of B and its left singular vector.
template <class T> T lowest_direction(Mat6<T> B, Vec6<T>& u) {
  Mat6<T> U;
  for (int i = 0; i < 6; ++i) U[i][i] = T(1.0);
  orthogonalise_rows<6, 6, T>(B.a, U.a);
  T least = row_square(B.a[0]);
  for (int k = 0; k < 6; ++k) u[k] = U[0][k];
  for (int i = 1; i < 6; ++i) {
    const T square = row_square(B.a[i]);
    const auto lower = square < least;
    least = select(lower, square, least);
    for (int k = 0; k < 6; ++k) u[k] = select(lower, U[i][k], u[k]);
  }
  return least;
}

}  // namespace flexapod
