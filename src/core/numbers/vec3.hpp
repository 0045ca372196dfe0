// Vectors and 3x3 matrices of three-dimensional mechanics, over any scalar. Mixed scalars are allowed:
// a design in double times a pose in Dual gives Dual.
#pragma once

#include "numbers/scalar.hpp"

namespace flexapod {

template <class T> struct Vec3 {
  T x{}, y{}, z{};

  Vec3() = default;
  Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  template <class U>
    requires(!std::is_same_v<T, U> && std::is_constructible_v<T, U>)
  Vec3(const Vec3<U>& b) : x(b.x), y(b.y), z(b.z) {}  // NOLINT: a constant vector is a vector

  template <class U> Vec3& operator+=(const Vec3<U>& b) { return *this = *this + b; }
  template <class U> Vec3& operator-=(const Vec3<U>& b) { return *this = *this - b; }
};

template <class A, class B> Vec3<product_t<A, B>> operator+(const Vec3<A>& a, const Vec3<B>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class A, class B> Vec3<product_t<A, B>> operator-(const Vec3<A>& a, const Vec3<B>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T> Vec3<T> operator-(const Vec3<T>& a) { return {-a.x, -a.y, -a.z}; }
template <Scalar A, class B> Vec3<product_t<A, B>> operator*(const A& a, const Vec3<B>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
template <class A, class B> product_t<A, B> dot(const Vec3<A>& a, const Vec3<B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class A, class B> Vec3<product_t<A, B>> cross(const Vec3<A>& a, const Vec3<B>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> T norm(const Vec3<T>& a) { return sqrt(dot(a, a)); }

/// A 3x3 matrix by rows; for axes (s, y, z) as rows, M * v resolves v in those axes and transposed(M, v) goes back.
template <class T> struct Mat3 {
  Vec3<T> row[3];

  static Mat3 identity() { return {{{T(1.0), T(0.0), T(0.0)}, {T(0.0), T(1.0), T(0.0)}, {T(0.0), T(0.0), T(1.0)}}}; }
};

template <class A, class B> Vec3<product_t<A, B>> operator*(const Mat3<A>& m, const Vec3<B>& v) {
  return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
}
template <class A, class B> Vec3<product_t<A, B>> transposed(const Mat3<A>& m, const Vec3<B>& v) {
  return v.x * m.row[0] + v.y * m.row[1] + v.z * m.row[2];
}
template <class T> Mat3<T> transpose(const Mat3<T>& m) {
  const auto& r = m.row;
  return {{{r[0].x, r[1].x, r[2].x}, {r[0].y, r[1].y, r[2].y}, {r[0].z, r[1].z, r[2].z}}};
}
template <class A, class B> Mat3<product_t<A, B>> operator*(const Mat3<A>& m, const Mat3<B>& n) {
  return {{transposed(n, m.row[0]), transposed(n, m.row[1]), transposed(n, m.row[2])}};
}

/// A symmetric 3x3 matrix: an inertia.
template <class T> struct Sym3 {
  T xx{}, yy{}, zz{}, xy{}, xz{}, yz{};
};

template <class A, class B> Vec3<product_t<A, B>> operator*(const Sym3<A>& m, const Vec3<B>& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}
template <class T> Sym3<T> operator+(const Sym3<T>& a, const Sym3<T>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
/// Parallel axes: what a mass m at r adds to the inertia about the origin, m (r^2 E - r r^T).
template <class T> Sym3<T> point_inertia(const T& m, const Vec3<T>& r) {
  return {m * (r.y * r.y + r.z * r.z),
          m * (r.x * r.x + r.z * r.z),
          m * (r.x * r.x + r.y * r.y),
          -m * r.x * r.y,
          -m * r.x * r.z,
          -m * r.y * r.z};
}
/// R I R^T for a rotation with body axes as columns.
template <class A, class B> Sym3<product_t<A, B>> rotate(const Mat3<A>& R, const Sym3<B>& I) {
  const auto a = I * R.row[0], b = I * R.row[1], c = I * R.row[2];
  return {dot(R.row[0], a), dot(R.row[1], b), dot(R.row[2], c), dot(R.row[0], b), dot(R.row[0], c), dot(R.row[1], c)};
}

}  // namespace flexapod
