// Singular values by one-sided Jacobi rotations: accurate to a small multiple of eps times the norm for every
// singular value, and, since rows are only rotated, often far better for the small ones.
#pragma once

#include <algorithm>

#include "numbers/linear6.hpp"

namespace flexapod {

/// B = U diag(sigma) V^T. Ascending sigma; u: left singular vectors as columns, orthonormal also where sigma is zero.
struct SingularValues {
  double sigma[6];
  Mat6<double> u;

  explicit SingularValues(const Mat6<double>& B) {
    Mat6<double> rows = B, U;  // rows of U^T B become orthogonal
    for (int i = 0; i < 6; ++i) U[i][i] = 1.0;
    for (int sweep = 0; sweep < 40 && !rotate_all(rows, U); ++sweep) {
    }
    int order[6] = {0, 1, 2, 3, 4, 5};
    double length[6];
    for (int i = 0; i < 6; ++i) length[i] = std::sqrt(row_dot(rows.a[i], rows.a[i]));
    std::sort(order, order + 6, [&](int i, int j) { return length[i] < length[j]; });
    for (int j = 0; j < 6; ++j) {
      sigma[j] = length[order[j]];
      for (int i = 0; i < 6; ++i) u[i][j] = U[order[j]][i];
    }
  }

 private:
  static double row_dot(const double* a, const double* b) {
    double sum = 0;
    for (int k = 0; k < 6; ++k) sum += a[k] * b[k];
    return sum;
  }
  /// One sweep over all pairs of rows; true when they were orthogonal already.
  static bool rotate_all(Mat6<double>& rows, Mat6<double>& U) {
    bool done = true;
    for (int p = 0; p < 5; ++p)
      for (int q = p + 1; q < 6; ++q) {
        const double pp = row_dot(rows.a[p], rows.a[p]), qq = row_dot(rows.a[q], rows.a[q]);
        const double pq = row_dot(rows.a[p], rows.a[q]);
        if (!(std::abs(pq) > 1e-16 * std::sqrt(pp * qq))) continue;
        done = false;
        const double zeta = (qq - pp) / (2.0 * pq);
        const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::sqrt(1.0 + zeta * zeta));
        const double c = 1.0 / std::sqrt(1.0 + t * t), s = c * t;
        turn(rows.a[p], rows.a[q], c, s);
        turn(U.a[p], U.a[q], c, s);
      }
    return done;
  }
  static void turn(double* a, double* b, double c, double s) {
    for (int k = 0; k < 6; ++k) {
      const double x = a[k], y = b[k];
      a[k] = c * x - s * y;
      b[k] = s * x + c * y;
    }
  }
};

}  // namespace flexapod
