// Which springs a design has beside constant ones along its legs. It is asked once for a machine, so that one without
// them does nothing for them.
#pragma once

#include "model/design.hpp"
#include "numbers/dual.hpp"

namespace flexapod {

/// Whether a number, or that of any lane, is not zero.
template <class T> bool nonzero(const T& x) { return any((x < T(0.0)) | (x > T(0.0))); }

/// A number that is a whole one, the same in all lanes.
inline int whole(double x) { return static_cast<int>(x); }
template <int N, class T> int whole(const Dual<N, T>& x) { return whole(x.v); }
template <class T>
  requires requires { T::lanes; }
int whole(const T& x) {
  double lane[T::lanes];
  x.store(lane);
  return whole(lane[0]);
}

struct Features {
  Law law = Law::constant;
  bool series = false, joints = false, suspension = false;

  Features() = default;
  template <class T> explicit Features(const Design<T>& d) : law(static_cast<Law>(whole(d.law))) {
    for (const LegSprings<T>& s : d.springs) {
      series = series || nonzero(s.series_compliance);
      joints = joints || nonzero(s.k_u[0]) || nonzero(s.k_u[1]) || nonzero(s.k_s) || nonzero(s.k_t);
    }
    for (int i = 0; i < 21; ++i)
      suspension = suspension || nonzero(d.suspension_stiffness.a[i]) || nonzero(d.suspension_damping.a[i]);
  }
  /// Whether there are springs that do not lie along the legs.
  bool others() const { return joints || suspension; }

  friend Features operator|(Features a, const Features& b) {
    a.law = std::max(a.law, b.law);
    a.series = a.series || b.series, a.joints = a.joints || b.joints, a.suspension = a.suspension || b.suspension;
    return a;
  }
};

}  // namespace flexapod
