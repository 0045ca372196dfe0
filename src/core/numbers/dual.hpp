// Forward-mode derivatives: a value and its N partial derivatives, exact to rounding.
#pragma once

#include "numbers/scalar.hpp"

namespace flexapod {

template <int N, class T = double> struct Dual {
  T v{};
  T d[N]{};

  Dual() = default;
  Dual(T value) : v(value) {}  // NOLINT: a constant is a dual number with no derivative
  Dual(double value)           // NOLINT: the same where T holds many numbers
    requires(!std::is_same_v<T, double>)
      : v(value) {}

  static Dual variable(T value, int index) {
    Dual x(value);
    x.d[index] = T(1.0);
    return x;
  }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }

  friend Dual operator-(const Dual& a) { return chain(-a.v, T(-1.0), a); }
  friend Dual operator+(const Dual& a, const Dual& b) { return chain(a.v + b.v, T(1.0), a, T(1.0), b); }
  friend Dual operator-(const Dual& a, const Dual& b) { return chain(a.v - b.v, T(1.0), a, T(-1.0), b); }
  friend Dual operator*(const Dual& a, const Dual& b) { return chain(a.v * b.v, b.v, a, a.v, b); }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T inverse = T(1.0) / b.v, ratio = a.v * inverse;
    return chain(ratio, inverse, a, -ratio * inverse, b);
  }
  // With a constant: its derivatives are not multiplied by zero.
  template <class U> static constexpr bool constant = std::is_same_v<U, T> || std::is_arithmetic_v<U>;
  template <class U>
    requires(constant<U>)
  friend Dual operator+(const Dual& a, const U& b) {
    Dual r = a;
    r.v = a.v + T(b);
    return r;
  }
  template <class U>
    requires(constant<U>)
  friend Dual operator+(const U& a, const Dual& b) {
    return b + a;
  }
  template <class U>
    requires(constant<U>)
  friend Dual operator-(const Dual& a, const U& b) {
    return a + -T(b);
  }
  template <class U>
    requires(constant<U>)
  friend Dual operator-(const U& a, const Dual& b) {
    return -b + a;
  }
  template <class U>
    requires(constant<U>)
  friend Dual operator*(const Dual& a, const U& b) {
    return chain(a.v * T(b), T(b), a);
  }
  template <class U>
    requires(constant<U>)
  friend Dual operator*(const U& a, const Dual& b) {
    return b * a;
  }
  template <class U>
    requires(constant<U>)
  friend Dual operator/(const Dual& a, const U& b) {
    return a * (T(1.0) / T(b));
  }
  friend auto operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend auto operator>(const Dual& a, const Dual& b) { return a.v > b.v; }

  /// f(a) with f' = da.
  static FLEXAPOD_INLINE Dual chain(T value, T da, const Dual& a) {
    Dual r(value);
    for (int i = 0; i < N; ++i) r.d[i] = da * a.d[i];
    return r;
  }
  /// f(a, b) with the partial derivatives da and db.
  static FLEXAPOD_INLINE Dual chain(T value, T da, const Dual& a, T db, const Dual& b) {
    Dual r(value);
    for (int i = 0; i < N; ++i) r.d[i] = da * a.d[i] + db * b.d[i];
    return r;
  }
};

template <int N, class T> struct is_scalar<Dual<N, T>> : std::true_type {};

template <int N, class T> Dual<N, T> sqrt(const Dual<N, T>& a) {
  const T root = sqrt(a.v);
  return Dual<N, T>::chain(root, T(0.5) / root, a);
}
template <int N, class T> Dual<N, T> rsqrt(const Dual<N, T>& a) {
  const T root = rsqrt(a.v);
  return Dual<N, T>::chain(root, T(-0.5) * root * root * root, a);
}
template <int N, class T> Dual<N, T> abs(const Dual<N, T>& a) {
  return Dual<N, T>::chain(abs(a.v), select(a.v < T(0.0), T(-1.0), T(1.0)), a);
}
template <int N, class T> Dual<N, T> upper_angle(const Dual<N, T>& y, const Dual<N, T>& x) {
  const T inverse = T(1.0) / (x.v * x.v + y.v * y.v);
  return Dual<N, T>::chain(upper_angle(y.v, x.v), x.v * inverse, y, -y.v * inverse, x);
}
template <int N, class T, class M> Dual<N, T> select(M take_a, const Dual<N, T>& a, const Dual<N, T>& b) {
  Dual<N, T> r(select(take_a, a.v, b.v));
  for (int i = 0; i < N; ++i) r.d[i] = select(take_a, a.d[i], b.d[i]);
  return r;
}

}  // namespace flexapod
