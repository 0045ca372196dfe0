// Numbers of the design that are known up to a range only: places as models, each stray a variable from -1 to 1.
#pragma once

#include "certify/task.hpp"
#include "certify/taylor.hpp"
#include "model/machine.hpp"

namespace flexapod {

/// What of a design may stray, with what templates take beside it.
template <class T> struct StrayingPlaces {
  Vec3<T> b[6], p[6];  // joints
  Vec3<T> R_0;         // mass centre of the platform
  Vec3<double> k[6];
  double M;
  Sym3<double> I_p;

  StrayingPlaces(const Design<double>& d, const certify_task::Task& task) : M(d.M), I_p(d.I_p) {
    const double* const first = &d.gravity.x;
    const auto number = [&](const double& value) {
      T x(value);
      for (int s = 0; s < task.strays; ++s) x.c[T::terms + s] = task.reach[s * design_size + (&value - first)];
      x.r = rounding::unit * std::abs(value) + rounding::least;  // the ends of its range are rounded
      return x;
    };
    const auto place = [&](const Vec3<double>& v) { return Vec3<T>(number(v.x), number(v.y), number(v.z)); };
    for (int i = 0; i < 6; ++i) b[i] = place(d.b[i]), p[i] = place(d.p[i]), k[i] = d.k[i];
    R_0 = place(d.R_0);
  }
};

/// Whether a number of a design may stray.
inline bool may_stray(const Design<double>& d, int number) {
  const double* const at = &d.gravity.x + number;
  const auto among = [&](const Vec3<double>* places, int count) {
    return at >= &places->x && at < &places->x + 3 * count;
  };
  return among(d.b, 6) || among(d.p, 6) || among(&d.R_0, 1);
}

}  // namespace flexapod
