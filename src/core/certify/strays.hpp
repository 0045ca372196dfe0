// Numbers of the design that are known up to a range only: places as models, each stray a variable from -1 to 1.
#pragma once

#include "certify/task.hpp"
#include "certify/taylor.hpp"
#include "model/machine.hpp"

namespace flexapod {

inline constexpr int stray_numbers = design_size + 3;  // of the design, and the place of its payload

/// The place of a vector's first number among those of its design.
inline int number_of(const Design<double>& d, const Vec3<double>& v) { return static_cast<int>(&v.x - &d.gravity.x); }

/// What of a design may stray, with what templates take beside it.
template <class T> struct StrayingPlaces {
  Vec3<T> b[6], p[6];  // joints
  Vec3<T> R_0;         // mass centre of the platform
  Vec3<T> payload;     // of a point mass on it
  Vec3<double> k[6];
  double M;
  Sym3<double> I_p;

  StrayingPlaces(const Design<double>& d, const certify_task::Task& task) : M(d.M), I_p(d.I_p) {
    const auto number = [&](double value, int at) {
      T x(value);
      for (int s = 0; s < task.strays; ++s) x.c[T::terms + s] = task.reach[s * stray_numbers + at];
      x.r = rounding::unit * std::abs(value) + rounding::least;  // the ends of its range are rounded
      return x;
    };
    const auto vector = [&](const Vec3<double>& v, int at) {
      return Vec3<T>(number(v.x, at), number(v.y, at + 1), number(v.z, at + 2));
    };
    const auto place = [&](const Vec3<double>& v) { return vector(v, number_of(d, v)); };
    for (int i = 0; i < 6; ++i) b[i] = place(d.b[i]), p[i] = place(d.p[i]), k[i] = d.k[i];
    R_0 = place(d.R_0);
    payload = vector({task.payload[1], task.payload[2], task.payload[3]}, design_size);
  }
};

/// The inertia of the platform with its payload, in its own axes.
template <class T, class Places> Mat6<T> loaded_platform(const Places& places, double payload) {
  SpatialInertia<T> J = platform_inertia(places, Mat3<T>::identity());
  const T m(payload), zero(0.0);
  J.add(places.payload, Sym3<T>{m, m, m, zero, zero, zero});
  return J.matrix();
}

/// Whether a number may stray: of a design, or after these of its payload's place.
inline bool may_stray(const Design<double>& d, int number) {
  if (number >= design_size) return true;
  const double* const at = &d.gravity.x + number;
  const auto among = [&](const Vec3<double>* places, int count) {
    return at >= &places->x && at < &places->x + 3 * count;
  };
  return among(d.b, 6) || among(d.p, 6) || among(&d.R_0, 1);
}

}  // namespace flexapod
