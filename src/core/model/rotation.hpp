// Finite rotations: exp and log, kept to full relative precision for rotations as small as vibrations are.
#pragma once

#include "model/motion.hpp"

namespace flexapod {

/// exp(e) - 1 applied to v, to relative precision.
template <class T> Vec3<T> turned_change(const Vec3<double>& e, const Vec3<T>& v) {
  const Turn turn(dot(e, e));
  const Vec3<T> e_x_v = cross(e, v);
  return turn.sine * e_x_v + turn.versine * cross(e, e_x_v);
}

/// A unit quaternion w + [x, y, z]; products compose rotations as matrices do.
struct Quaternion {
  double w = 1.0;
  Vec3<double> v;

  /// exp(e).
  static Quaternion exp(const Vec3<double>& e) {
    const double angle = norm(e);
    return {std::cos(0.5 * angle), (angle > 0 ? std::sin(0.5 * angle) / angle : 0.5) * e};
  }
  /// The rotation vector, of length up to pi.
  Vec3<double> log() const {
    const double sine = norm(v), sign = w < 0 ? -1.0 : 1.0;
    if (!(sine > 0)) return 2.0 * sign * v;
    return sign * 2.0 * std::atan2(sine, std::abs(w)) / sine * v;
  }
  Quaternion inverse() const { return {w, -v}; }
  Quaternion normalised() const {
    const double scale = 1.0 / std::sqrt(w * w + dot(v, v));
    return {scale * w, scale * v};
  }
  /// The same rotation with its axis given in other axes: R applied to the vector part.
  Quaternion resolved(const Mat3<double>& R) const { return {w, R * v}; }
  Mat3<double> matrix() const { return quaternion_rotation(w, v); }
};

inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
}

/// Rate of a rotation vector theta for the angular velocity w of exp(theta), both in the axes that theta is given in:
/// w - theta x w / 2 + c theta x (theta x w), c = 1/theta^2 - cot(theta/2) / (2 theta). For angles below 2 pi.
inline Vec3<double> rotation_vector_rate(const Vec3<double>& theta, const Vec3<double>& w) {
  const double s = dot(theta, theta);
  double c;
  if (s < 0.25) {  // Bernoulli numbers B_2k / (2k)!: the first term left out is below 1e-17
    // clang-format off
    c = 1.0 / 12.0 + s * (1.0 / 720.0 + s * (1.0 / 30240.0 + s * (1.0 / 1209600.0 + s * (1.0 / 47900160.0 +
        s * (691.0 / 1307674368000.0 + s * (1.0 / 74724249600.0))))));
    // clang-format on
  } else {
    const double angle = std::sqrt(s);
    c = 1.0 / s - 0.5 / (angle * std::tan(0.5 * angle));
  }
  const Vec3<double> cross1 = cross(theta, w);
  return w - 0.5 * cross1 + c * cross(theta, cross1);
}

/// Sums of (-s)^k (k+1)^p / (2k + first)!, p = 0 or 1: the coefficients of the exponential map's differential.
inline double factorial_series(double s, int first, bool weighted) {
  double term = 1.0, sum = 0.0;
  for (int i = 2; i <= first; ++i) term /= i;
  for (int k = 0; k < 16; ++k) {
    sum += weighted ? (k + 1) * term : term;
    term *= -s / ((2 * k + first + 1) * (2 * k + first + 2));
  }
  return sum;
}

/// Angular velocity and acceleration of exp(e(t)) from e and its derivatives, inertial axes.
struct RotationVectorRates {
  Vec3<double> w, alpha;

  RotationVectorRates(const Vec3<double>& e, const Vec3<double>& e1, const Vec3<double>& e2) {
    const double s = dot(e, e), s1 = 2.0 * dot(e, e1);
    double c1, c2, d1, d2;  // (1 - cos)/s, (angle - sin)/(s angle) and their derivatives by s
    if (s < 4.0) {          // the closed forms lose digits here; 16 terms leave 1e-20
      c1 = factorial_series(s, 2, false), c2 = factorial_series(s, 3, false);
      d1 = -factorial_series(s, 4, true), d2 = -factorial_series(s, 5, true);
    } else {
      const double angle = std::sqrt(s), sine = std::sin(angle), cosine = std::cos(angle);
      c1 = (1.0 - cosine) / s, c2 = (angle - sine) / (s * angle);
      d1 = (angle * sine - 2.0 * (1.0 - cosine)) / (2.0 * s * s);
      d2 = (3.0 * sine - angle * (2.0 + cosine)) / (2.0 * s * s * angle);
    }
    const Vec3<double> a = cross(e, e1), b = cross(e, a), a1 = cross(e, e2);
    w = e1 + c1 * a + c2 * b;
    alpha = e2 + c1 * a1 + c2 * (cross(e1, a) + cross(e, a1)) + s1 * (d1 * a + d2 * b);
  }
};

/// The same for roll, pitch, yaw about the fixed axes x, y, z in this order: R = R_z(yaw) R_y(pitch) R_x(roll).
struct RollPitchYaw {
  Quaternion turn;
  Vec3<double> w, alpha;

  RollPitchYaw(const Vec3<double>& angle, const Vec3<double>& rate, const Vec3<double>& acceleration) {
    const Quaternion yaw = Quaternion::exp({0.0, 0.0, angle.z}), pitch = Quaternion::exp({0.0, angle.y, 0.0});
    const Quaternion tilt = yaw * pitch;
    turn = tilt * Quaternion::exp({angle.x, 0.0, 0.0});
    const Vec3<double> z(0.0, 0.0, 1.0), y(-std::sin(angle.z), std::cos(angle.z), 0.0);
    const Vec3<double> x(std::cos(angle.z) * std::cos(angle.y), std::sin(angle.z) * std::cos(angle.y),
                         -std::sin(angle.y));
    const Vec3<double> w_z = rate.z * z, w_zy = w_z + rate.y * y;
    w = w_zy + rate.x * x;
    alpha =
        acceleration.z * z + acceleration.y * y + acceleration.x * x + cross(w_z, rate.y * y) + cross(w_zy, rate.x * x);
  }
};

}  // namespace flexapod
