// Symmetric 6x6 matrices that belong to a body: inertia and stiffness seen at its reference point.
#pragma once

#include "numbers/linear6.hpp"

namespace flexapod {

/// A symmetric 6x6 inertia [top, bottom_left^T; bottom_left, bottom]: of a velocity and an angular velocity.
template <class T> struct SpatialInertia {
  Sym3<T> top;
  Mat3<T> bottom_left;
  Sym3<T> bottom;

  /// Adds [Q, -Q q~; q~ Q, -q~ Q q~] with Q symmetric: the inertia Q at the point q.
  template <class P> void add(const Vec3<P>& q, const Sym3<T>& Q) {
    const Mat3<T> right{{cross(q, Vec3<T>(Q.xx, Q.xy, Q.xz)), cross(q, Vec3<T>(Q.xy, Q.yy, Q.yz)),
                         cross(q, Vec3<T>(Q.xz, Q.yz, Q.zz))}};
    const Mat3<T> left = transpose(right);
    const Vec3<T> x = cross(q, left.row[0]), y = cross(q, left.row[1]), z = cross(q, left.row[2]);
    top = top + Q;
    for (int i = 0; i < 3; ++i) bottom_left.row[i] += left.row[i];
    bottom = bottom + Sym3<T>{x.x, y.y, z.z, y.x, z.x, z.y};
  }
  /// Adds [0, G^T; G, N] at the point q: what couples the velocity of that point and the angular velocity.
  template <class P> void add_coupled(const Vec3<P>& q, const Mat3<T>& G, const Sym3<T>& N) {
    const Vec3<T> x = cross(q, G.row[0]), y = cross(q, G.row[1]), z = cross(q, G.row[2]);
    for (int i = 0; i < 3; ++i) bottom_left.row[i] += G.row[i];
    bottom = bottom + Sym3<T>{N.xx + 2.0 * x.x, N.yy + 2.0 * y.y, N.zz + 2.0 * z.z,
                              N.xy + x.y + y.x, N.xz + x.z + z.x, N.yz + y.z + z.y};
  }
  SpatialInertia operator+(const SpatialInertia& other) const {
    const Mat3<T>&a = bottom_left, &b = other.bottom_left;
    return {top + other.top, {{a.row[0] + b.row[0], a.row[1] + b.row[1], a.row[2] + b.row[2]}}, bottom + other.bottom};
  }
  Mat6<T> matrix() const {
    const Mat3<T> right = transpose(bottom_left);
    const Mat3<T> A = full(top), D = full(bottom);
    Mat6<T> J;
    for (int i = 0; i < 3; ++i) {
      const Vec6<T> upper = Vec6<T>::of(A.row[i], right.row[i]), lower = Vec6<T>::of(bottom_left.row[i], D.row[i]);
      for (int j = 0; j < 6; ++j) J[i][j] = upper[j], J[3 + i][j] = lower[j];
    }
    return J;
  }

 private:
  static Mat3<T> full(const Sym3<T>& m) { return {{{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}}}; }
};

}  // namespace flexapod
