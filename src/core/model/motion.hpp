// Where a body is and how it moves, in the inertial frame.
#pragma once

#include "model/layout.hpp"
#include "numbers/linear6.hpp"

namespace flexapod {

template <class T> struct Pose {
  Vec3<T> t;                        // reference point, m
  Mat3<T> R = Mat3<T>::identity();  // rotation from body to inertial axes
};

/// 24 scalars in this order; an array of 24 is a motion.
template <class T> struct Motion {
  Pose<T> pose;
  Vec3<T> v, w;      // velocity of the reference point and angular velocity, m/s, rad/s
  Vec3<T> a, alpha;  // accelerations, m/s2, rad/s2

  /// Acceleration of the body's point at q from its reference point (the terms of Eqs 8 and 9).
  template <class U> Vec3<product_t<T, U>> acceleration_at(const Vec3<U>& q) const {
    return a + cross(alpha, q) + cross(w, cross(w, q));
  }
  template <class U> Vec3<product_t<T, U>> velocity_at(const Vec3<U>& q) const { return v + cross(w, q); }
};

inline constexpr int motion_size = sizeof(Motion<double>) / sizeof(double);
inline constexpr int pose_size = sizeof(Pose<double>) / sizeof(double);

/// Every field of a motion, in the order of its numbers; the first two are the pose.
inline constexpr std::array motion_layout{
    field<Vec3<double>>("position", offsetof(Motion<double>, pose.t), "m"),
    field<Mat3<double>>("matrix", offsetof(Motion<double>, pose.R), ""),
    field<Vec3<double>>("velocity", offsetof(Motion<double>, v), "m/s"),
    field<Vec3<double>>("angular_velocity", offsetof(Motion<double>, w), "rad/s"),
    field<Vec3<double>>("acceleration", offsetof(Motion<double>, a), "m/s2"),
    field<Vec3<double>>("angular_acceleration", offsetof(Motion<double>, alpha), "rad/s2")};
static_assert(cover<motion_size>(motion_layout));

/// The pose moved by a small displacement: t + d, and R turned by the rotation vector e, exact to first order
/// (all that derivatives need).
template <class T, class U> Pose<T> displaced(const Pose<U>& pose, const Vec3<T>& d, const Vec3<T>& e) {
  Pose<T> moved;
  moved.t = pose.t + d;
  const Mat3<U> columns = transpose(pose.R);
  Mat3<T> turned;
  for (int j = 0; j < 3; ++j) turned.row[j] = columns.row[j] + cross(e, columns.row[j]);
  moved.R = transpose(turned);
  return moved;
}

/// Coefficients of Rodrigues' formula exp(e) = 1 + sine e~ + versine e~ e~, precise for every angle.
struct Turn {
  double sine, versine;

  explicit Turn(double angle2) {
    if (angle2 < 0.25) {  // the first terms left out are below 1e-17
      const double s = angle2;
      // clang-format off
      sine = 1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0 * (1.0 - s / 110.0 *
             (1.0 - s / 156.0 * (1.0 - s / 210.0))))));
      versine = 0.5 * (1.0 - s / 12.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0 * (1.0 - s / 90.0 * (1.0 - s / 132.0 *
                (1.0 - s / 182.0))))));
      // clang-format on
      return;
    }
    const double half = 0.5 * std::sqrt(angle2), sinc = half > 0 ? std::sin(half) / half : 1.0;
    sine = std::cos(half) * sinc;
    versine = 0.5 * sinc * sinc;
  }
};

/// The rotation exp(e) by Rodrigues' formula, for |e|^2 and its coefficients.
template <class T> Mat3<T> rotation(const Vec3<T>& e, const T& angle2, const T& a, const T& half) {
  const T c = 1.0 - half * angle2;
  return {{{c + half * e.x * e.x, half * e.x * e.y - a * e.z, half * e.x * e.z + a * e.y},
           {half * e.x * e.y + a * e.z, c + half * e.y * e.y, half * e.y * e.z - a * e.x},
           {half * e.x * e.z - a * e.y, half * e.y * e.z + a * e.x, c + half * e.z * e.z}}};
}
inline Mat3<double> rotation(const Vec3<double>& e) {
  const double angle2 = dot(e, e);
  const auto [a, half] = Turn(angle2);
  return rotation(e, angle2, a, half);
}

/// R_z(yaw) R_y(pitch) R_x(roll) from sines and cosines of roll, pitch, yaw.
template <class T> Mat3<T> roll_pitch_yaw(const Vec3<T>& sine, const Vec3<T>& cosine) {
  const T &sr = sine.x, &cr = cosine.x, &sp = sine.y, &cp = cosine.y, &sy = sine.z, &cy = cosine.z;
  return {{{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
           {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
           {-sp, cp * sr, cp * cr}}};
}

/// The rotation of a quaternion w + [x, y, z] of length one.
template <class T> Mat3<T> quaternion_rotation(const T& w, const Vec3<T>& v) {
  const T &x = v.x, &y = v.y, &z = v.z;
  return {{{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
           {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
           {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}}};
}

/// The pose moved by a finite displacement: t + d, exp(e) R.
inline Pose<double> moved(const Pose<double>& pose, const Vec6<double>& x) {
  return {pose.t + x.top(), rotation(x.bottom()) * pose.R};
}

}  // namespace flexapod
