// Angles between directions and their turns, for every scalar: precise for angles as small as vibrations are.
#pragma once

#include "numbers/dual.hpp"
#include "numbers/vec3.hpp"
#include "simd/elementary.hpp"

namespace flexapod {

/// The angle, -pi to pi, of a vector with the parts x and y.
template <class T> T signed_angle(const T& y, const T& x) {
  const auto below = y < T(0.0);
  const T angle = upper_angle(select(below, -y, y), x);
  return select(below, -angle, angle);
}

/// Roll, pitch and yaw of a rotation: pitch within +-pi/2, and yaw 0 where it is +-pi/2.
template <class T> Vec3<T> roll_pitch_yaw_of(const Mat3<T>& R) {
  const T level = sqrt(R.row[0].x * R.row[0].x + R.row[1].x * R.row[1].x);
  const auto steep = level <= T(1e-12);                                                   // not where R holds NaN
  const auto angle = [](const T& y, const T& x) { return signed_angle(y + T(0.0), x); };  // -0 is 0
  const T roll = angle(select(steep, -R.row[1].z, R.row[2].y), select(steep, R.row[1].y, R.row[2].z));
  const T yaw = select(steep, T(0.0), angle(R.row[1].x, R.row[0].x));
  return {roll, angle(-R.row[2].x, level), yaw};
}

/// theta / sin(theta) and its derivative by cos(theta), of an angle below pi given by both. Below 0.2 rad by the series
/// in h = (1 - cos)/2 = sin^2(theta/2) of arcsin(sqrt h) / sqrt(h (1 - h)).
template <class T> struct AngleRatio {
  T value, slope;

  AngleRatio(const T& sine, const T& cosine) {
    // clang-format off
    constexpr double a[] = {1.0, 2.0 / 3, 8.0 / 15, 16.0 / 35, 128.0 / 315, 256.0 / 693, 1024.0 / 3003, 2048.0 / 6435,
                            32768.0 / 109395};
    constexpr double b[] = {-1.0 / 3, -8.0 / 15, -24.0 / 35, -256.0 / 315, -640.0 / 693, -1024.0 / 1001,
                            -7168.0 / 6435, -131072.0 / 109395};  // -n a_n / 2
    // clang-format on
    const auto small = cosine > T(0.98);
    const T h = 0.5 * (1.0 - cosine), square = sine * sine;
    const T ratio = upper_angle(sine, cosine) / sine;
    value = select(small, polynomial(a, h), ratio);
    slope = select(small, polynomial(b, h), (cosine * ratio - 1.0) / square);
  }
};

/// The rotation vector of a rotation by less than pi, and what its rate is made of.
template <class T> struct RotationLog {
  Vec3<T> vector;
  T curl;  // c of the rate w - v x w / 2 + c v x (v x w) for the angular velocity w

  explicit RotationLog(const Mat3<T>& R) {
    const Vec3<T> twice(R.row[2].y - R.row[1].z, R.row[0].z - R.row[2].x, R.row[1].x - R.row[0].y);
    const Vec3<T> sines = T(0.5) * twice;
    const T cosine = 0.5 * (R.row[0].x + R.row[1].y + R.row[2].z - 1.0);
    const T ratio = AngleRatio<T>(norm(sines), cosine).value;
    vector = ratio * sines;
    const T s = dot(vector, vector);
    // Bernoulli numbers B_2k / (2k)!
    constexpr double c[] = {1.0 / 12, 1.0 / 720, 1.0 / 30240, 1.0 / 1209600, 1.0 / 47900160, 691.0 / 1307674368000.0};
    curl = select(cosine > T(0.98), polynomial(c, s), (1.0 - 0.5 * ratio * (1.0 + cosine)) / s);
  }
  /// J^T f, for the vector's rate J w: the moment that does the same work as forces f on the vector's parts.
  Vec3<T> moment(const Vec3<T>& f) const {
    const Vec3<T> v_x_f = cross(vector, f);
    return f + T(0.5) * v_x_f + curl * cross(vector, v_x_f);
  }
};

}  // namespace flexapod
