// Springs in the joints of a leg: flexures that bend about two axes at the base and at the platform, and twist between
// the leg and the platform. First their stiffness where they are unstressed, then their moments at any rotation.
#pragma once

#include "model/joint_rest.hpp"
#include "model/spatial_inertia.hpp"

namespace flexapod {

inline constexpr int springs_of_joints =
    5;  // of one leg: two of the universal joint, two that bend above, one that twists

/// The directions of the springs of a leg's joints, as those of `springs.hpp`: each the wrench on the platform for a
/// unit moment, which makes it the rate of the joint's angle by the platform's twist. With w the leg's angular velocity
/// and w_p the platform's in leg axes they are w_z / sin(k, s), w_y; (w_p - w)_y, (w_p - w)_z; (w_p - w)_x.
template <class T> struct JointDirections {
  Vec6<T> d[springs_of_joints];

  template <class P> JointDirections(const LegAxes<T>& leg, const Vec3<P>& q_p, Joint joint) {
    const Vec3<T>&s = leg.axes.row[0], &y = leg.axes.row[1], &z = leg.axes.row[2];
    const T u = leg.u, first = joint == Joint::universal ? u * leg.cosecant : u;
    const auto at_joint = [&](const Vec3<T>& force, const Vec3<T>& moment) {
      return Vec6<T>::of(force, cross(q_p, force) + moment);
    };
    const Vec3<T> none{};
    d[0] = at_joint(first * y, none);
    d[1] = at_joint(-(u * z), none);
    d[2] = at_joint(u * z, y);
    d[3] = at_joint(-(u * y), z);
    d[4] = at_joint(-(leg.tau * u * y), s);
  }
};

/// The stiffnesses that go with the directions, N m/rad.
template <class D> const D& joint_stiffness(const LegSprings<D>& springs, int j) {
  return j < 2 ? springs.k_u[j] : j < 4 ? springs.k_s : springs.k_t;
}

/// Adds sum k d d^T of a leg's joints to the stiffness K of the platform.
template <class T, class D, class P>
void add_joint_stiffness(SpatialInertia<T>& K, const LegAxes<T>& leg, const LegSprings<D>& springs, const Vec3<P>& q_p,
                         Joint joint) {
  const Vec3<T>&s = leg.axes.row[0], &y = leg.axes.row[1], &z = leg.axes.row[2];
  const T u = leg.u, first = joint == Joint::universal ? leg.cosecant : T(1.0), zero(0.0);
  const T across = u * u * (springs.k_u[0] * (first * first) + springs.k_s + springs.k_t * (leg.tau * leg.tau));
  const T along = u * u * (springs.k_u[1] + springs.k_s);
  const Vec3<T> y_k = across * y, z_k = along * z;
  const Sym3<T> Q{y_k.x * y.x + z_k.x * z.x, y_k.y * y.y + z_k.y * z.y, y_k.z * y.z + z_k.z * z.z,
                  y_k.x * y.y + z_k.x * z.y, y_k.x * y.z + z_k.x * z.z, y_k.y * y.z + z_k.y * z.z};
  const T bend = u * springs.k_s, twist = (leg.tau * u) * springs.k_t, more = T(springs.k_t - springs.k_s);
  const Vec3<T> b = bend * s, t = twist * y;
  const Mat3<T> G{
      {Vec3<T>(zero, b.z, -b.y) - s.x * t, Vec3<T>(-b.z, zero, b.x) - s.y * t, Vec3<T>(b.y, -b.x, zero) - s.z * t}};
  const Vec3<T> m = more * s;
  const T k_s(springs.k_s);
  K.add(q_p, Q);
  K.add_coupled(q_p, G, {k_s + m.x * s.x, k_s + m.y * s.y, k_s + m.z * s.z, m.x * s.y, m.x * s.z, m.y * s.z});
}

/// The angles about the two axes of a universal joint from where its springs are unstressed.
template <class T> struct UniversalAngles {
  T first, second;

  template <class D, class R>
  UniversalAngles(const JointRest<D>& rest, const LegAxes<T>& leg, const Vec3<T>& axis, const Mat3<R>& R_b) {
    const Vec3<T>&y = leg.axes.row[1], from(R_b * rest.in_base.row[1]);
    first = signed_angle(dot(axis, cross(from, y)), dot(from, y));
    second = signed_angle(leg.tau, T(1.0)) - rest.tilt;
  }
};

/// The angles of a leg's joints from where they are unstressed, and the moments that hold them there, N m.
template <class T> struct JointSprings {
  T first, second;  // universal joint; in the spin-free model the leg's swing from its rest, across k and about it
  T bend_2, twist;  // squared angle between the leg and its direction in the platform at rest; twist between them, rad
  Vec3<T> universal;  // leg axes: does the work of the joint's springs at the rate of the leg relative to the base
  Vec3<T> spherical;  // leg axes: likewise relative to the platform; on the platform by the leg

  template <class D, class P, class B>
  JointSprings(const LegSprings<D>& k, const JointRest<D>& rest, const LegAxes<T>& leg, const Vec3<T>& axis,
               const Mat3<P>& R_p, const Mat3<B>& R_b, Joint joint) {
    const Vec3<T>& s = leg.s();
    const auto carried = [&](int r) { return Vec3<T>(R_b * rest.in_base.row[r]); };
    if (joint == Joint::universal) {
      const UniversalAngles<T> angles(rest, leg, axis, R_b);
      first = angles.first, second = angles.second;
      universal = {T(0.0), -(k.k_u[1] * second), k.k_u[0] * first * leg.cosecant};
      spherical = on_platform(k, rest, R_p, leg.axes);
      return;
    }
    const Vec3<T> n = carried(0), y = carried(1), z = carried(2), turn = cross(n, s), half = n + s;
    const T cosine = dot(n, s), inverse = 1.0 / (1.0 + cosine);
    const AngleRatio<T> ratio(norm(turn), cosine);
    first = ratio.value * dot(z, turn), second = ratio.value * dot(y, turn);
    const Vec3<T> moment = (k.k_u[0] * first) * z + (k.k_u[1] * second) * y;
    const Vec3<T> slope = ratio.value * cross(moment, n) + (ratio.slope * dot(moment, turn)) * n;
    const auto swung = [&](const Vec3<T>& v) { return v - (inverse * dot(v, s)) * half; };
    const Mat3<T> frame{{s, swung(y), swung(z)}};
    spherical = leg.axes * transposed(frame, on_platform(k, rest, R_p, frame));
    universal = leg.axes * (cross(s, slope) + (k.k_t * twist * inverse) * half);
  }
  /// About the two axes of the universal joint together, and of the bending at the platform, N m.
  template <class D> T universal_moment(const LegSprings<D>& k) const {
    const T about_first = k.k_u[0] * first, about_second = k.k_u[1] * second;
    return sqrt(about_first * about_first + about_second * about_second);
  }
  template <class D> T spherical_moment(const LegSprings<D>& k) const { return k.k_s * sqrt(bend_2); }
  template <class D> T energy(const LegSprings<D>& k) const {
    return 0.5 * (k.k_u[0] * (first * first) + k.k_u[1] * (second * second) + k.k_s * bend_2 + k.k_t * (twist * twist));
  }

 private:
  /// Bending by the angle between s and the neutral direction m in the platform; the twist about them is what is left
  /// of the turn from rest after the least turn from s to m, and its moment acts along their middle.
  template <class D, class R>
  Vec3<T> on_platform(const LegSprings<D>& k, const JointRest<D>& rest, const Mat3<R>& R_p, const Mat3<T>& frame) {
    const auto turned = [&](int r) { return frame * Vec3<T>(R_p * rest.in_platform.row[r]); };
    const Vec3<T> m = turned(0), y = turned(1), z = turned(2);
    const T sine_2 = m.y * m.y + m.z * m.z, ratio = AngleRatio<T>(sqrt(sine_2), m.x).value;
    bend_2 = ratio * ratio * sine_2;
    twist = signed_angle(y.z - z.y, y.y + z.z);
    const T bending = -(k.k_s * ratio), torsion = -(k.k_t * twist), side = torsion / (1.0 + m.x);
    return {torsion, side * m.y - bending * m.z, side * m.z + bending * m.y};
  }
};

/// Adds the moments of the springs of a leg's joints to what its spherical joint carries. Axis: k; R_p, R_b: of platform
/// and base.
template <class T, class D, class P, class B>
FLEXAPOD_APART void add_joint_springs(SphericalLoad<T>& load, const LegSprings<D>& k, const JointRest<D>& rest,
                                      const LegAxes<T>& leg, const Vec3<T>& axis, const Mat3<P>& R_p,
                                      const Mat3<B>& R_b, Joint joint) {
  const JointSprings<T> springs(k, rest, leg, axis, R_p, R_b, joint);
  load.moment += springs.spherical;
  load.force += leg.W_transposed(springs.universal + springs.spherical);
}

}  // namespace flexapod
