// Householder's reflections for lanes, and what they make of a matrix with more columns than rows.
#pragma once

#include "numbers/linear6.hpp"
#include "simd/pack.hpp"

namespace flexapod {

/// Sum of products in two chains.
template <int m, class A, class B> FLEXAPOD_INLINE auto inner(const A& a, const B& b) {
  auto even = a(0) * b(0);
  if constexpr (m == 1) {
    return even;
  } else {
    auto odd = a(1) * b(1);
    FLEXAPOD_UNROLL
    for (int i = 2; i < m; ++i)
      if (i % 2) odd += a(i) * b(i);
      else even += a(i) * b(i);
    return even + odd;
  }
}

/// The reflection E - beta v v^T that turns x into its first axis: v is x with `shift` added to its first part. For
/// x = 0 it is the identity.
template <class T> struct Reflection {
  T square, shift, beta;  // square = |x|^2

  template <int m, class X> static FLEXAPOD_INLINE Reflection of(const X& x) {
    Reflection r;
    r.square = inner<m>(x, x);
    const T length = sqrt(r.square), first = x(0);
    r.shift = select(first < 0.0, -length, length);
    r.beta = select(r.square > 1e-280, 1.0 / (r.square + abs(first) * length), T(0.0));
    return r;
  }
  /// Reflects y; x as it was given.
  template <int m, class X, class Y> FLEXAPOD_INLINE void apply(const X& x, const Y& y) const {
    const T sum = beta * (inner<m>(x, y) + shift * y(0));  // the inner product does not wait for the length
    y(0) -= sum * (x(0) + shift);
    FLEXAPOD_UNROLL
    for (int i = 1; i < m; ++i) y(i) -= sum * x(i);
  }
};

template <int k, int m, class T> FLEXAPOD_INLINE void lower_step(Mat6<T, m>& B, Mat6<T>& L) {
  const auto row = [&](int i) { return [&B, i](int j) -> T& { return B[i][k + j]; }; };
  const auto reflection = Reflection<T>::template of<m - k>(row(k));
  for (int i = k + 1; i < 6; ++i) reflection.template apply<m - k>(row(k), row(i));
  L[k][k] = -reflection.shift;
  for (int i = k + 1; i < 6; ++i) L[i][k] = B[i][k];
  if constexpr (k < 5) lower_step<k + 1>(B, L);
}

/// A 6x6 matrix with the singular values and left singular vectors of B, which is overwritten: L of B = L Q. A product
/// B B^T would cost half the digits.
template <int m, class T> FLEXAPOD_INLINE Mat6<T> square_factor(Mat6<T, m>& B) {
  Mat6<T> L;
  for (int i = 0; i < 5; ++i)
    for (int j = i + 1; j < 6; ++j) L[i][j] = T(0.0);
  lower_step<0>(B, L);
  return L;
}
template <class T> FLEXAPOD_INLINE Mat6<T>& square_factor(Mat6<T>& B) { return B; }

/// The 6x12 matrix [A, C] with a lower triangular C.
template <class T> struct Blocks {
  Mat6<T> A, C;

  /// Of all squared entries of C.
  T square_of_C() const {
    T sum = C[0][0] * C[0][0];
    for (int i = 1; i < 6; ++i)
      for (int j = 0; j <= i; ++j) sum += C[i][j] * C[i][j];
    return sum;
  }
  Mat6<T, 12> joined() const {
    Mat6<T, 12> all;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) all[i][j] = A[i][j], all[i][6 + j] = C[i][j];
    return all;
  }
};

template <int k, class T> FLEXAPOD_INLINE void lower_step(Blocks<T>& B, Mat6<T>& L) {
  const auto row = [&](int i) { return [&B, i](int j) -> T& { return j == 0 ? B.C[i][k] : B.A[i][j - 1]; }; };
  const auto reflection = Reflection<T>::template of<7>(row(k));
  for (int i = k + 1; i < 6; ++i) reflection.template apply<7>(row(k), row(i));
  L[k][k] = -reflection.shift;
  for (int i = k + 1; i < 6; ++i) L[i][k] = B.C[i][k];
  if constexpr (k < 5) lower_step<k + 1>(B, L);
}

/// As above; row k has but one entry of C when it is turned, so that seven entries are turned at a time.
template <class T> FLEXAPOD_INLINE Mat6<T> square_factor(Blocks<T>& B) {
  Mat6<T> L;
  for (int i = 0; i < 5; ++i)
    for (int j = i + 1; j < 6; ++j) L[i][j] = T(0.0);
  lower_step<0>(B, L);
  return L;
}

}  // namespace flexapod
