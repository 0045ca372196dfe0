// Singular values by one-sided Jacobi rotations, of one matrix or of many in lanes: accurate to a small multiple of eps
// times the norm for every singular value, often far better for the small ones, and indifferent to repeated ones. For
// lanes slower than the bidiagonal form.
#pragma once

#include <algorithm>

#include "decomposition/reflection.hpp"
#include "numbers/linear6.hpp"
#include "simd/pack.hpp"

namespace flexapod {

template <int n, class T> FLEXAPOD_INLINE void turn(T (&a)[n], T (&b)[n], const T& c, const T& s) {
  for (int k = 0; k < n; ++k) {
    const T x = a[k], y = b[k];
    a[k] = c * x - s * y;
    b[k] = s * x + c * y;
  }
}

/// The rotation that makes two rows orthogonal. False where they are so already, in all lanes.
template <int n, class T> FLEXAPOD_INLINE bool rotation_of(const T (&a)[n], const T (&b)[n], T& c, T& s) {
  T aa = a[0] * a[0], bb = b[0] * b[0], ab = a[0] * b[0];
  for (int k = 1; k < n; ++k) aa += a[k] * a[k], bb += b[k] * b[k], ab += a[k] * b[k];
  const auto open = ab * ab > 1e-32 * (aa * bb);
  if (!any(open)) return false;
  const T zeta = (bb - aa) / (2.0 * select(open, ab, T(1.0)));
  const T t = select(zeta < 0.0, T(-1.0), T(1.0)) / (abs(zeta) + sqrt(1.0 + zeta * zeta));
  c = select(open, rsqrt(1.0 + t * t), T(1.0));
  s = select(open, c * t, T(0.0));
  return true;
}

/// Rotates m rows of n until all are orthogonal: their lengths are then the singular values. U, if given, is rotated
/// too.
template <int m, int n, class T> void orthogonalise_rows(T (&rows)[m][n], T (*U)[m]) {
  bool turned = true;
  for (int sweep = 0; sweep < 40 && turned; ++sweep) {
    turned = false;
    for (int p = 0; p < m - 1; ++p)
      for (int q = p + 1; q < m; ++q) {
        T c, s;
        if (!rotation_of(rows[p], rows[q], c, s)) continue;
        turned = true;
        turn(rows[p], rows[q], c, s);
        if (U != nullptr) turn(U[p], U[q], c, s);
      }
  }
}

template <int n, class T> FLEXAPOD_INLINE T row_square(const T (&a)[n]) {
  T sum = a[0] * a[0];
  for (int k = 1; k < n; ++k) sum += a[k] * a[k];
  return sum;
}

/// B = U diag(sigma) V^T. Ascending sigma; u: left singular vectors as columns, orthonormal also where sigma is zero.
struct SingularValues {
  double sigma[6];
  Mat6<double> u;

  template <int m> explicit SingularValues(Mat6<double, m> rows) {  // those of U^T B become orthogonal
    Mat6<double> U;
    for (int i = 0; i < 6; ++i) U[i][i] = 1.0;
    orthogonalise_rows<6, m, double>(rows.a, U.a);
    int order[6] = {0, 1, 2, 3, 4, 5};
    double length[6];
    for (int i = 0; i < 6; ++i) length[i] = std::sqrt(row_square(rows.a[i]));
    std::sort(order, order + 6, [&](int i, int j) { return length[i] < length[j]; });
    for (int j = 0; j < 6; ++j) {
      sigma[j] = length[order[j]];
      for (int i = 0; i < 6; ++i) u[i][j] = U[order[j]][i];
    }
  }
};

/// The six squared singular values of B in each lane, ascending.
template <int m, class T> void squares_by_rotations(Mat6<T, m> B, T (&value)[6]) {
  orthogonalise_rows<6, m, T>(B.a, nullptr);
  for (int i = 0; i < 6; ++i) value[i] = row_square(B.a[i]);
  for (int last = 5; last > 0; --last)
    for (int i = 0; i < last; ++i) {
      const T low = min(value[i], value[i + 1]), high = max(value[i], value[i + 1]);
      value[i] = low, value[i + 1] = high;
    }
}

template <class T> void squares_by_rotations(const Blocks<T>& B, T (&value)[6]) {
  squares_by_rotations(B.joined(), value);
}

/// The least squared singular value of B in each lane, and its left singular vector.
template <int m, class T> T lowest_direction(Mat6<T, m> B, Vec6<T>& u) {
  Mat6<T> U;
  for (int i = 0; i < 6; ++i) U[i][i] = T(1.0);
  orthogonalise_rows<6, m, T>(B.a, U.a);
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
template <class T> T lowest_direction(const Blocks<T>& B, Vec6<T>& u) { return lowest_direction(B.joined(), u); }

}  // namespace flexapod
