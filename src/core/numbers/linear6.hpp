// Linear algebra of six rows, mostly six by six: small fixed loops, no branch on the data except in `solve_general`.
#pragma once

#include "numbers/vec3.hpp"

namespace flexapod {

template <class T> struct Vec6 {
  T a[6]{};
  T& operator[](int i) { return a[i]; }
  const T& operator[](int i) const { return a[i]; }
  static Vec6 of(const Vec3<T>& top, const Vec3<T>& bottom) {
    return {{top.x, top.y, top.z, bottom.x, bottom.y, bottom.z}};
  }
  Vec3<T> top() const { return {a[0], a[1], a[2]}; }
  Vec3<T> bottom() const { return {a[3], a[4], a[5]}; }
};

/// Six rows of m.
template <class T, int m = 6> struct Mat6 {
  T a[6][m]{};
  T* operator[](int i) { return a[i]; }
  const T* operator[](int i) const { return a[i]; }
};

template <class T> void add(Vec6<T>& to, const Vec3<T>& top, const Vec3<T>& bottom) {
  const Vec6<T> v = Vec6<T>::of(top, bottom);
  for (int i = 0; i < 6; ++i) to[i] += v[i];
}
template <class A, class B> Vec6<product_t<A, B>> operator*(const Mat6<A>& m, const Vec6<B>& v) {
  Vec6<product_t<A, B>> r;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) r[i] += m[i][j] * v[j];
  return r;
}
template <class T> Vec6<T> transposed(const Mat6<T>& m, const Vec6<T>& v) {
  Vec6<T> r;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) r[j] += m[i][j] * v[i];
  return r;
}
template <class A, class B> product_t<A, B> dot(const Vec6<A>& a, const Vec6<B>& b) {
  product_t<A, B> sum = a[0] * b[0];
  for (int i = 1; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

/// Cholesky factor of a symmetric positive definite matrix (its lower triangle is read); the diagonal holds reciprocals.
template <class T> struct Cholesky {
  T l[6][6];

  explicit Cholesky(const Mat6<T>& m) {
    FLEXAPOD_UNROLL
    for (int j = 0; j < 6; ++j) {
      T pivot = m[j][j];
      FLEXAPOD_UNROLL
      for (int k = 0; k < j; ++k) pivot = pivot - l[j][k] * l[j][k];
      l[j][j] = rsqrt(pivot);
      FLEXAPOD_UNROLL
      for (int i = j + 1; i < 6; ++i) {
        T sum = m[i][j];
        FLEXAPOD_UNROLL
        for (int k = 0; k < j; ++k) sum = sum - l[i][k] * l[j][k];
        l[i][j] = sum * l[j][j];
      }
    }
  }
  Vec6<T> forward(Vec6<T> b) const {  // L x = b
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < i; ++k) b[i] = b[i] - l[i][k] * b[k];
      b[i] = b[i] * l[i][i];
    }
    return b;
  }
  template <int m> void forward_all(Mat6<T, m>& B) const {  // L X = B, in place
    FLEXAPOD_UNROLL
    for (int j = 0; j < m; ++j) FLEXAPOD_UNROLL
    for (int i = 0; i < 6; ++i) {
      T sum = B[i][j];
      FLEXAPOD_UNROLL
      for (int k = 0; k < i; ++k) sum = sum - l[i][k] * B[k][j];
      B[i][j] = sum * l[i][i];
    }
  }
  void forward_lower(Mat6<T>& C) const {  // L X = C for a lower triangular C, in place
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j) {
        T sum = C[i][j];
        for (int k = j; k < i; ++k) sum = sum - l[i][k] * C[k][j];
        C[i][j] = sum * l[i][i];
      }
  }
  Vec6<T> backward(Vec6<T> b) const {  // L^T x = b
    for (int i = 5; i >= 0; --i) {
      for (int k = i + 1; k < 6; ++k) b[i] = b[i] - l[k][i] * b[k];
      b[i] = b[i] * l[i][i];
    }
    return b;
  }
  Vec6<T> solve(const Vec6<T>& b) const { return backward(forward(b)); }
};

/// A lower triangular C with C C^T = m for a positive semidefinite m (its lower triangle is read), without a branch: a
/// pivot is at least a rounding of the diagonal's three entries of its unit, and C C^T differs from m by that much.
template <class T> Mat6<T> semidefinite_root(const Mat6<T>& m) {
  Mat6<T> C;
  for (int r = 0; r < 6; ++r)
    for (int j = r + 1; j < 6; ++j) C[r][j] = T(0.0);
  for (int j = 0; j < 6; ++j) {
    const int first = j < 3 ? 0 : 3;
    const T least = 1e-16 * (m[first][first] + m[first + 1][first + 1] + m[first + 2][first + 2]) + 1e-300;
    T pivot = m[j][j];
    for (int k = 0; k < j; ++k) pivot = pivot - C[j][k] * C[j][k];
    pivot = max(pivot, least);
    const T inverse = rsqrt(pivot);
    C[j][j] = pivot * inverse;
    for (int i = j + 1; i < 6; ++i) {
      T sum = m[i][j];
      for (int k = 0; k < j; ++k) sum = sum - C[i][k] * C[j][k];
      C[i][j] = sum * inverse;
    }
  }
  return C;
}

/// Solves m x = b for a symmetric positive definite m (its lower triangle is read) by m = L D L^T: no square root waits
/// for another, as those of a Cholesky factor do. NaN where m is not positive definite.
inline Vec6<double> solve_positive(Mat6<double> m, Vec6<double> b) {
  double reciprocal[6], least = m[0][0];
  FLEXAPOD_UNROLL
  for (int j = 0; j < 6; ++j) {
    least = std::min(least, m[j][j]);
    reciprocal[j] = 1.0 / m[j][j];
    FLEXAPOD_UNROLL
    for (int i = j + 1; i < 6; ++i) {
      const double factor = m[i][j] * reciprocal[j];
      FLEXAPOD_UNROLL
      for (int k = j + 1; k <= i; ++k) m[i][k] -= factor * m[k][j];
      b[i] -= factor * b[j];
    }
  }
  FLEXAPOD_UNROLL
  for (int i = 5; i >= 0; --i) {
    FLEXAPOD_UNROLL
    for (int k = i + 1; k < 6; ++k) b[i] -= m[k][i] * b[k];
    b[i] *= reciprocal[i];
  }
  if (!(least > 0)) b = Vec6<double>{{NAN, NAN, NAN, NAN, NAN, NAN}};
  return b;
}

/// Gaussian elimination with row pivoting on scaled rows. Returns false, and leaves x, where the matrix is singular
/// to rounding.
inline bool solve_general(Mat6<double> m, Vec6<double> b, Vec6<double>& x) {
  for (int i = 0; i < 6; ++i) {  // rows of force and of moment have different units: scale them to compare pivots
    double largest = 0;
    for (int j = 0; j < 6; ++j) largest = std::max(largest, std::abs(m[i][j]));
    if (!(largest > 0)) return false;
    const double scale = 1.0 / largest;
    for (int j = 0; j < 6; ++j) m[i][j] *= scale;
    b[i] *= scale;
  }
  for (int k = 0; k < 6; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 6; ++i)
      if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
    if (!(std::abs(m[pivot][k]) > 1e-14)) return false;
    std::swap(m.a[k], m.a[pivot]);
    std::swap(b[k], b[pivot]);
    const double reciprocal = 1.0 / m[k][k];
    for (int i = k + 1; i < 6; ++i) {
      const double factor = m[i][k] * reciprocal;
      for (int j = k + 1; j < 6; ++j) m[i][j] -= factor * m[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (int i = 5; i >= 0; --i) {
    for (int j = i + 1; j < 6; ++j) b[i] -= m[i][j] * b[j];
    b[i] /= m[i][i];
  }
  x = b;
  return true;
}

}  // namespace flexapod
