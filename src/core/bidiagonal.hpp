// Singular values of 6x6 matrices for many lanes at once, each to a few roundings of the largest: Householder's
// bidiagonal form, then Laguerre's method on the squares of its entries. From below all zeros of the characteristic
// polynomial the method rises to the lowest one and cannot miss it.
#pragma once

#include "linear6.hpp"
#include "pack.hpp"

namespace flexapod {

/// Squares of an upper bidiagonal matrix's entries: q on the diagonal, e above it. They fix the singular values, each
/// to a relative error of the order of their own.
template <int n, class T> struct SquaredBidiagonal {
  T q[n], e[n > 1 ? n - 1 : 1];
};

/// Overwrites x with the vector v of the reflection E - beta v v^T that turns x into its first axis. A vector of zeros
/// is left alone (beta = 0).
template <int m, class T> FLEXAPOD_INLINE T householder(T (&x)[m], T& square) {
  square = x[0] * x[0];
  T rest = x[m - 1] * x[m - 1];
  for (int i = 1; i < m - 1; ++i)
    if (i % 2) square += x[i] * x[i];
    else rest += x[i] * x[i];
  if constexpr (m > 1) square += rest;
  const T length = square * rsqrt(max(square, T(1e-280)));
  const T beta = 1.0 / (square + abs(x[0]) * length);
  x[0] = x[0] + select(x[0] < 0.0, -length, length);
  return select(square > 1e-280, beta, T(0.0));
}

template <int k, class T> FLEXAPOD_INLINE void bidiagonal_step(T (&a)[6][6], SquaredBidiagonal<6, T>& b) {
  if constexpr (k == 5) {
    b.q[5] = a[5][5] * a[5][5];
  } else {
    constexpr int m = 6 - k;
    T v[m];
    FLEXAPOD_UNROLL for (int i = 0; i < m; ++i) v[i] = a[k + i][k];
    T beta = householder(v, b.q[k]);
    FLEXAPOD_UNROLL for (int j = k + 1; j < 6; ++j) {
      T sum = v[0] * a[k][j];
      FLEXAPOD_UNROLL for (int i = 1; i < m; ++i) sum += v[i] * a[k + i][j];
      sum *= beta;
      FLEXAPOD_UNROLL for (int i = 0; i < m; ++i) a[k + i][j] -= sum * v[i];
    }
    if constexpr (k == 4) {
      b.e[4] = a[4][5] * a[4][5];
    } else {
      T w[m - 1];
      FLEXAPOD_UNROLL for (int j = 0; j < m - 1; ++j) w[j] = a[k][k + 1 + j];
      beta = householder(w, b.e[k]);
      FLEXAPOD_UNROLL for (int i = k + 1; i < 6; ++i) {
        T sum = w[0] * a[i][k + 1];
        FLEXAPOD_UNROLL for (int j = 1; j < m - 1; ++j) sum += w[j] * a[i][k + 1 + j];
        sum *= beta;
        FLEXAPOD_UNROLL for (int j = 0; j < m - 1; ++j) a[i][k + 1 + j] -= sum * w[j];
      }
    }
    bidiagonal_step<k + 1>(a, b);
  }
}

/// A is overwritten.
template <class T> FLEXAPOD_INLINE SquaredBidiagonal<6, T> bidiagonalise(Mat6<T>& A) {
  SquaredBidiagonal<6, T> b;
  bidiagonal_step<0>(A.a, b);
  return b;
}

/// Divides by the sum of squares of all singular values, and returns it.
template <int n, class T> FLEXAPOD_INLINE T normalise(SquaredBidiagonal<n, T>& b) {
  T sum = b.q[n - 1];
  for (int i = 0; i < n - 1; ++i) sum += b.q[i] + b.e[i];
  const T scale = 1.0 / sum;
  for (T& q : b.q) q *= scale;
  for (T& e : b.e) e *= scale;
  return sum;
}

/// prod(lambda_i - x) over the squared singular values, and its derivatives, without quotients. The recurrence is that
/// of the differential quotient-difference algorithm, multiplied out: its errors are relative changes of q, e and x.
template <int n, class T> struct Characteristic {
  T p, p1, p2;  // value, first derivative, half of the second

  FLEXAPOD_INLINE Characteristic(const SquaredBidiagonal<n, T>& b, const T& x) {
    p = b.q[0] - x, p1 = T(-1.0), p2 = T(0.0);
    T d(1.0), d1(0.0), d2(0.0);
    FLEXAPOD_UNROLL for (int i = 1; i < n; ++i) {
      d = p + b.e[i - 1] * d, d1 = p1 + b.e[i - 1] * d1, d2 = p2 + b.e[i - 1] * d2;
      p = b.q[i] * p - x * d;
      p1 = b.q[i] * p1 - x * d1 - d;
      p2 = b.q[i] * p2 - x * d2 - d1;
    }
  }
};

inline constexpr int laguerre_limit = 60;  // six-fold zeros and simple ones take one to eight steps, others up to 45

/// The lowest squared singular value, from x = 0 upwards; x need only be accurate beside `offset`. `open`: lanes that
/// have not come to an end.
///
/// With G and S the sums of 1/(lambda_i - x) and of its square, Laguerre's step is at most the distance to the lowest
/// zero, and G/S at least that. They differ by a factor 1 + rho for an error rho^2/2 of the step: a lane is done when
/// that is below rounding.
template <int n, class T, class M> FLEXAPOD_INLINE T lowest(const SquaredBidiagonal<n, T>& b, const T& offset, M& open) {
  T x(0.0);
  auto active = T(0.0) < T(1.0);
  for (int step = 0; step < laguerre_limit && any(active); ++step) {
    const Characteristic<n, T> c(b, x);
    const T square = c.p1 * c.p1, curvature = 2.0 * c.p * c.p2;
    const T root = sqrt(max((n - 1.0) * ((n - 1.0) * square - n * curvature), T(0.0)));
    const T rise = n * c.p / (root - c.p1), most = -(c.p * c.p1) / (square - curvature);
    const auto below = active & (c.p > 0.0);  // else x is the zero, to rounding
    x = select(below, x + rise, x);
    const T gap = most - rise;
    active = below & (gap * gap > 1e-16 * (offset + x) * rise);
  }
  open = active;
  return x;
}

/// The highest squared singular value of a normalised b: the same from above.
template <int n, class T, class M> FLEXAPOD_INLINE T highest(const SquaredBidiagonal<n, T>& b, M& open) {
  static_assert(n % 2 == 0);
  T squares = b.q[0] * b.q[0];  // sum of squares of the zeros, whose sum is one
  for (int i = 1; i < n; ++i) {
    const T diagonal = b.q[i] + b.e[i - 1];
    squares += diagonal * diagonal + 2.0 * b.q[i - 1] * b.e[i - 1];
  }
  T x = 1.0 / n + sqrt(max((n - 1.0) / n * (squares - 1.0 / n), T(0.0)));  // no zero is higher
  auto active = T(0.0) < T(1.0);
  for (int step = 0; step < laguerre_limit && any(active); ++step) {
    const Characteristic<n, T> c(b, x);
    const T square = c.p1 * c.p1, curvature = 2.0 * c.p * c.p2;
    const T root = sqrt(max((n - 1.0) * ((n - 1.0) * square - n * curvature), T(0.0)));
    const T fall = n * c.p / (root + c.p1), most = c.p * c.p1 / (square - curvature);
    const auto above = active & (c.p > 0.0);
    x = select(above, x - fall, x);
    const T gap = most - fall;
    active = above & (gap * gap > 1e-16 * x * fall);
  }
  open = active;
  return x;
}

/// The form of order n - 1 that is left when the lowest squared singular value x is taken out and from all others:
/// two steps of the quotient-difference algorithm. `failed`: lanes where x did not come out at the end.
template <int n, class T, class M>
FLEXAPOD_INLINE SquaredBidiagonal<n - 1, T> deflated(const SquaredBidiagonal<n, T>& b, const T& x, const T& tolerance,
                                                     M& failed) {
  T q[n - 1], e[n - 1];
  T d = b.q[0] - x;
  FLEXAPOD_UNROLL for (int i = 0; i < n - 1; ++i) {
    q[i] = d + b.e[i];
    const T ratio = b.q[i + 1] / q[i];
    e[i] = b.e[i] * ratio;
    failed = failed | (!(q[i] > 0.0));
    d = d * ratio - x;
  }
  failed = failed | (!(abs(d) <= tolerance));
  SquaredBidiagonal<n - 1, T> rest;
  d = q[0];
  FLEXAPOD_UNROLL for (int i = 0; i < n - 2; ++i) {
    rest.q[i] = d + e[i];
    const T ratio = q[i + 1] / rest.q[i];
    rest.e[i] = e[i] * ratio;
    d = d * ratio;
  }
  rest.q[n - 2] = d + e[n - 2];
  return rest;
}

template <int n, class T, class M>
FLEXAPOD_INLINE void ascend(const SquaredBidiagonal<n, T>& b, const T& below, T* value, M& failed) {
  if constexpr (n == 2) {
    const T sum = b.q[0] + b.q[1] + b.e[0], gap = b.q[0] - b.q[1];
    const T high = 0.5 * (sum + sqrt(gap * gap + b.e[0] * (b.e[0] + 2.0 * (b.q[0] + b.q[1]))));
    value[0] = below + b.q[0] * b.q[1] / high;
    value[1] = below + high;
  } else {
    M open;
    const T x = lowest(b, below, open);
    value[0] = below + x;
    failed = failed | open;
    ascend(deflated(b, x, 2e-14 * value[0], failed), value[0], value + 1, failed);
  }
}

/// All squared singular values, ascending. `failed`: lanes to be done another way (repeated values).
template <class T, class M> FLEXAPOD_INLINE void all_six(const SquaredBidiagonal<6, T>& b, T (&value)[6], M& failed) {
  failed = T(1.0) < T(0.0);
  ascend(b, T(0.0), value, failed);
}

}  // namespace flexapod
