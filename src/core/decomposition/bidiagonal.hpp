// Singular values of 6x6 matrices for many lanes at once, each to a few roundings of the largest: Householder's
// bidiagonal form, then Laguerre's method on the squares of its entries. From below all zeros of the characteristic
// polynomial the method rises to the lowest one and cannot miss it.
#pragma once

#include "decomposition/reflection.hpp"
#include "numbers/linear6.hpp"

namespace flexapod {

/// Squares of an upper bidiagonal matrix's entries: q on the diagonal, e above it. They fix the singular values, each
/// to a relative error of the order of their own.
template <int n, class T> struct SquaredBidiagonal {
  T q[n], e[n > 1 ? n - 1 : 1];
};

/// Steps k to last - 1 of an n x n matrix, which is overwritten; q and e from those of step 0 on.
template <int k, int last, int n, class T> FLEXAPOD_INLINE void bidiagonal_steps(T (&a)[n][n], T* q, T* e) {
  if constexpr (k == n - 1) {
    q[k] = a[k][k] * a[k][k];
  } else if constexpr (k < last) {
    const auto column = [&](int j) { return [&a, j](int i) -> T& { return a[k + i][j]; }; };
    const auto left = Reflection<T>::template of<n - k>(column(k));
    q[k] = left.square;
    FLEXAPOD_UNROLL
    for (int j = k + 1; j < n; ++j) left.template apply<n - k>(column(k), column(j));
    if constexpr (k == n - 2) {
      e[k] = a[k][n - 1] * a[k][n - 1];
    } else {
      const auto row = [&](int i) { return [&a, i](int j) -> T& { return a[i][k + 1 + j]; }; };
      const auto right = Reflection<T>::template of<n - 1 - k>(row(k));
      e[k] = right.square;
      FLEXAPOD_UNROLL
      for (int i = k + 1; i < n; ++i) right.template apply<n - 1 - k>(row(k), row(i));
    }
    bidiagonal_steps<k + 1, last>(a, q, e);
  }
}

/// A 6x6 matrix after its first two steps. They are most of the work; in the others one operation waits for the one
/// before, so that several matrices had better take them side by side.
template <class T> struct HalfBidiagonal {
  T q[2], e[2], rest[4][4];

  HalfBidiagonal() = default;
  /// A is overwritten.
  FLEXAPOD_INLINE explicit HalfBidiagonal(Mat6<T>& A) {
    bidiagonal_steps<0, 2>(A.a, q, e);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) rest[i][j] = A.a[2 + i][2 + j];
  }
  /// The rest is overwritten.
  FLEXAPOD_INLINE SquaredBidiagonal<6, T> finish() {
    SquaredBidiagonal<6, T> b;
    for (int i = 0; i < 2; ++i) b.q[i] = q[i], b.e[i] = e[i];
    bidiagonal_steps<0, 4>(rest, b.q + 2, b.e + 2);
    return b;
  }
  /// f of each number here and the same number of another.
  template <class U, class F> FLEXAPOD_INLINE void for_each(HalfBidiagonal<U>& other, F&& f) const {
    for (int i = 0; i < 2; ++i) f(q[i], other.q[i]), f(e[i], other.e[i]);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) f(rest[i][j], other.rest[i][j]);
  }
};

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
    FLEXAPOD_UNROLL
    for (int i = 1; i < n; ++i) {
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
template <int n, class T, class M>
FLEXAPOD_INLINE T lowest(const SquaredBidiagonal<n, T>& b, const T& offset, M& open) {
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

/// One step of the differential quotient-difference algorithm: the form whose squared singular values are lower by x.
/// Its last q is zero when x is the lowest of them. `failed`: lanes where it is no real form.
template <int n, class T, class M>
FLEXAPOD_INLINE SquaredBidiagonal<n, T> shifted(const SquaredBidiagonal<n, T>& b, const T& x, M& failed) {
  SquaredBidiagonal<n, T> next;
  T d = b.q[0] - x;
  FLEXAPOD_UNROLL
  for (int i = 0; i < n - 1; ++i) {
    next.q[i] = d + b.e[i];
    const T ratio = b.q[i + 1] / next.q[i];
    next.e[i] = b.e[i] * ratio;
    failed = failed | (!(next.q[i] > 0.0));
    d = d * ratio - x;
  }
  next.q[n - 1] = d;
  return next;
}

/// The form of order n - 1 that is left when the lowest squared singular value x is taken out and from all others.
/// `failed`: lanes where x did not come out at the end.
template <int n, class T, class M>
FLEXAPOD_INLINE SquaredBidiagonal<n - 1, T> deflated(const SquaredBidiagonal<n, T>& b, const T& x, const T& tolerance,
                                                     M& failed) {
  SquaredBidiagonal<n, T> rest = shifted(b, x, failed);
  auto left = !(abs(rest.q[n - 1]) <= tolerance);      // rounding, large where the value hardly lives at the end
  for (int step = 0; step < 3 && any(left); ++step) {  // each step brings it there
    const SquaredBidiagonal<n, T> next = shifted(rest, T(0.0), failed);
    for (int i = 0; i < n; ++i) rest.q[i] = select(left, next.q[i], rest.q[i]);
    for (int i = 0; i < n - 1; ++i) rest.e[i] = select(left, next.e[i], rest.e[i]);
    left = left & (!(abs(rest.q[n - 1]) <= tolerance));
  }
  failed = failed | left;
  // The last q is zero now; a step without it draws the last e in.
  SquaredBidiagonal<n - 1, T> result;
  T d = rest.q[0];
  FLEXAPOD_UNROLL
  for (int i = 0; i < n - 2; ++i) {
    result.q[i] = d + rest.e[i];
    const T ratio = rest.q[i + 1] / result.q[i];
    result.e[i] = rest.e[i] * ratio;
    d = d * ratio;
  }
  result.q[n - 2] = d + rest.e[n - 2];
  return result;
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

/// The squared singular values above the lowest, ascending. `failed`: lanes to be done another way (repeated values).
template <class T, class M>
FLEXAPOD_INLINE void other_five(const SquaredBidiagonal<6, T>& b, T (&value)[6], M& failed) {
  ascend(deflated(b, value[0], 2e-14 * value[0], failed), value[0], value + 1, failed);
}

}  // namespace flexapod
