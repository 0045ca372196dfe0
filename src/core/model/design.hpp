// A hexapod as numbers. `Design` is scalars in a fixed order and nothing else, so that an array of as many is a design,
// and the derivative by any number of it is one more dual part. A new number is one line of the lists below: the
// structures and the table of their layout are made of them.
#pragma once

#include <algorithm>

#include "model/joint.hpp"
#include "model/layout.hpp"

namespace flexapod {

// FIELD(type, member, key of the design file, unit)
#define FLEXAPOD_LEG_PART_FIELDS(FIELD, table)                                          \
  FIELD(T, mass, table "mass", "kg")                                                    \
  FIELD(Vec3<T>, mass_center, table "mass_center", "m") /* from the part's own joint */ \
  FIELD(Sym3<T>, inertia, table "inertia", "kg m2")     /* about the part's mass centre */

#define FLEXAPOD_LEG_FIELDS(FIELD)                                        \
  FIELD(T, stiffness, "legs.stiffness", "N/m")                            \
  FIELD(T, C_p, "legs.damping.prismatic", "N s/m") /* viscous friction */ \
  FIELD(T, C_u, "legs.damping.universal", "N m s/rad")                    \
  FIELD(T, C_s, "legs.damping.spherical", "N m s/rad")

#define FLEXAPOD_DESIGN_FIELDS(FIELD)                                                  \
  FIELD(Vec3<T>, gravity, "gravity", "m/s2")            /* inertial frame */           \
  FIELD(EachLeg<Vec3<T>>, b, "base.joints", "m")        /* base frame */               \
  FIELD(EachLeg<Vec3<T>>, k, "base.universal_axes", "") /* unit vectors, base frame */ \
  FIELD(EachLeg<Vec3<T>>, p, "platform.joints", "m")    /* platform frame */           \
  FIELD(T, M, "platform.mass", "kg")                    /* with payload */             \
  FIELD(Vec3<T>, R_0, "platform.mass_center", "m")      /* platform frame */           \
  FIELD(Sym3<T>, I_p, "platform.inertia", "kg m2")      /* about the mass centre, platform axes */

#define FLEXAPOD_MEMBER(type, member, key, unit) type member;

/// One of the two parts of a leg; leg axes are x = s (base joint to platform joint), y = k x s normalised, z = x x y.
/// The lower part is measured from the base joint, the upper part from the platform joint.
template <class T> struct LegPart {
  FLEXAPOD_LEG_PART_FIELDS(FLEXAPOD_MEMBER, )
};

template <class T> struct Leg {
  FLEXAPOD_LEG_FIELDS(FLEXAPOD_MEMBER)
  LegPart<T> lower, upper;
};

template <class T> struct Design {
  FLEXAPOD_DESIGN_FIELDS(FLEXAPOD_MEMBER)
  Leg<T> leg[6];
};

inline constexpr int design_size = sizeof(Design<double>) / sizeof(double);

/// Every field of a design, in the order of its numbers.
inline constexpr auto design_layout = [] {
  using T = double;
  constexpr std::size_t leg = offsetof(Design<T>, leg);
  constexpr int stride = sizeof(Leg<T>) / sizeof(T);
#define FLEXAPOD_OF_DESIGN(type, member, key, unit) field<type>(key, offsetof(Design<T>, member), unit),
#define FLEXAPOD_OF_LEG(type, member, key, unit) field<type>(key, leg + offsetof(Leg<T>, member), unit, stride),
#define FLEXAPOD_OF_LOWER(type, member, key, unit) FLEXAPOD_OF_LEG(type, lower.member, key, unit)
#define FLEXAPOD_OF_UPPER(type, member, key, unit) FLEXAPOD_OF_LEG(type, upper.member, key, unit)
  return std::array{FLEXAPOD_DESIGN_FIELDS(FLEXAPOD_OF_DESIGN) FLEXAPOD_LEG_FIELDS(FLEXAPOD_OF_LEG)
                        FLEXAPOD_LEG_PART_FIELDS(FLEXAPOD_OF_LOWER, "legs.lower.")
                            FLEXAPOD_LEG_PART_FIELDS(FLEXAPOD_OF_UPPER, "legs.upper.")};
#undef FLEXAPOD_OF_DESIGN
#undef FLEXAPOD_OF_LEG
#undef FLEXAPOD_OF_LOWER
#undef FLEXAPOD_OF_UPPER
}();
static_assert(cover<design_size>(design_layout));

#undef FLEXAPOD_MEMBER

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
