// A hexapod as numbers. `Design` is 211 scalars in a fixed order and nothing else, so that an array of 211 is a
// design, and the derivative by any number of it is one more dual part.
#pragma once

#include <algorithm>

#include "numbers/vec3.hpp"

namespace flexapod {

/// One of the two parts of a leg; leg axes are x = s (base joint to platform joint), y = k x s normalised, z = x x y.
template <class T> struct LegPart {
  T mass;               // kg
  Vec3<T> mass_center;  // m; lower part: from the base joint, upper part: from the platform joint
  Sym3<T> inertia;      // kg m2, about its mass centre, leg axes
};

template <class T> struct Leg {
  T stiffness;      // K, N/m
  T C_p, C_u, C_s;  // viscous friction: prismatic N s/m, universal and spherical N m s/rad
  LegPart<T> lower, upper;
};

template <class T> struct Design {
  Vec3<T> gravity;  // m/s2, inertial frame
  Vec3<T> b[6];     // base joints, base frame, m
  Vec3<T> k[6];     // universal joint axes fixed in the base, unit vectors, base frame
  Vec3<T> p[6];     // platform joints, platform frame, m
  T M;              // platform with payload, kg
  Vec3<T> R_0;      // its mass centre, platform frame, m
  Sym3<T> I_p;      // its inertia about the mass centre, platform axes, kg m2
  Leg<T> leg[6];
};

inline constexpr int design_size = 211;
static_assert(sizeof(Design<double>) == design_size * sizeof(double));

/// A leg's inertia as its dynamics need it: about the joints instead of the mass centres, in leg axes.
/// The lower part turns about the base joint, the upper part moves with the platform joint and turns about it.
template <class T> struct LegInertia {
  T m_u;
  Vec3<T> c_d, c_u;  // mass times mass centre: lower from the base joint, upper from the platform joint, kg m
  Sym3<T> J_d, J_u;  // about those joints, kg m2
  Sym3<T> J;         // J_d + J_u

  LegInertia() = default;
  explicit LegInertia(const Leg<T>& leg)
      : m_u(leg.upper.mass),
        c_d(leg.lower.mass * leg.lower.mass_center),
        c_u(leg.upper.mass * leg.upper.mass_center),
        J_d(about_joint(leg.lower)),
        J_u(about_joint(leg.upper)),
        J(J_d + J_u) {}

 private:
  static Sym3<T> about_joint(const LegPart<T>& part) {
    return part.inertia + point_inertia(part.mass, part.mass_center);
  }
};

/// Two sizes of the platform, about its reference point, m.
template <class T> T mean_radius(const Design<T>& d) {
  T sum(0.0);
  for (const auto& p : d.p) sum += norm(p) / 6.0;
  return sum;
}
inline double largest_radius(const Design<double>& d) {
  double largest = 0;
  for (const auto& p : d.p) largest = std::max(largest, norm(p));
  return largest;
}

enum class Joint {
  universal,  // exact: a universal joint lets the leg spin about itself as the base axis k demands
  spin_free   // the paper's W.s = 0 (corrections, part B)
};

/// A design with what is computed from it once.
template <class T> struct Machine {
  Design<T> design;
  Joint joint;
  LegInertia<T> inertia[6];

  Machine(const Design<T>& d, Joint j) : design(d), joint(j) {
    for (int i = 0; i < 6; ++i) inertia[i] = LegInertia<T>(d.leg[i]);
  }
};

}  // namespace flexapod
