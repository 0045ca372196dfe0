// long double as a scalar of the core, and whether Taylor models hold what it says.
#pragma once

#include "certify/pose_models.hpp"

namespace flexapod {

/// With functions that are found by its name.
struct Wide {
  long double v = 0;
  Wide() = default;
  Wide(long double value) : v(value) {}  // NOLINT
  friend Wide operator+(Wide a, Wide b) { return a.v + b.v; }
  friend Wide operator-(Wide a, Wide b) { return a.v - b.v; }
  friend Wide operator*(Wide a, Wide b) { return a.v * b.v; }
  friend Wide operator-(Wide a) { return -a.v; }
  friend Wide operator/(Wide a, Wide b) { return a.v / b.v; }
  friend bool operator<(Wide a, Wide b) { return a.v < b.v; }
  friend bool operator>(Wide a, Wide b) { return a.v > b.v; }
  Wide& operator+=(Wide b) { return v += b.v, *this; }
  Wide& operator-=(Wide b) { return v -= b.v, *this; }
};
inline Wide rsqrt(Wide a) { return 1.0L / std::sqrt(a.v); }
inline Wide upper_angle(Wide y, Wide x) { return std::atan2(y.v, x.v); }
inline Wide select(bool take_a, Wide a, Wide b) { return take_a ? a : b; }
inline Wide sqrt(Wide a) { return std::sqrt(a.v); }
template <> struct is_scalar<Wide> : std::true_type {};

using Lanes = Pack<Vector, 1>;

/// How far a model's function may be from an exact value, of its radius, in lane 0. strays: values of those.
template <class T>
double used(const T& model, const long double (&u)[T::variables], Wide exact, const long double* strays = nullptr) {
  constexpr const auto& m = monomials<T::variables, T::highest>;
  long double value = 0;
  for (int k = T::terms; k < T::count; ++k) value += lane_of(model.c[k], 0) * strays[k - T::terms];
  for (int k = 0; k < T::terms; ++k) {
    long double term = lane_of(model.c[k], 0);
    for (int i = 0; i < T::variables; ++i)
      for (int p = 0; p < m.power[k][i]; ++p) term *= u[i];
    value += term;
  }
  return static_cast<double>(std::abs(value - exact.v) / lane_of(model.r, 0));
}

/// x, y, z, roll, pitch, yaw at a point u of a box.
inline Pose<Wide> wide_pose(const Box& box, const long double (&u)[6]) {
  long double x[6];
  for (int i = 0; i < 6; ++i) x[i] = box.low[i] + (1 + u[i]) / 2 * (static_cast<long double>(box.high[i]) - box.low[i]);
  const Vec3<Wide> sine(std::sin(x[3]), std::sin(x[4]), std::sin(x[5]));
  const Vec3<Wide> cosine(std::cos(x[3]), std::cos(x[4]), std::cos(x[5]));
  return {{x[0], x[1], x[2]}, roll_pitch_yaw(sine, cosine)};
}

}  // namespace flexapod
