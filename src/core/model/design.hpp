// A hexapod as numbers. `Design` is scalars in a fixed order and nothing else, so that an array of as many is a design,
// and the derivative by any number of it is one more dual part. A new number is one line of the lists below: the
// structures and the table of their layout are made of them.
#pragma once

#include <algorithm>

#include "model/joint.hpp"
#include "model/layout.hpp"
#include "model/stiffness_law.hpp"

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

// Springs beside the constant one along the leg. The numbers of a stiffness law that the design does not have are 0.
#define FLEXAPOD_LEG_SPRING_FIELDS(FIELD)                                                                        \
  FIELD(T, series_compliance, "legs.series_compliance", "m/N") /* of all axial springs in series with the leg */ \
  FIELD(Pair<T>, k_u, "legs.joint_stiffness.universal", "N m/rad")                                               \
  FIELD(T, k_s, "legs.joint_stiffness.spherical", "N m/rad")                                                     \
  FIELD(T, k_t, "legs.joint_stiffness.torsion", "N m/rad")                                                       \
  FIELD(T, fixed, "legs.stiffness_law.fixed", "N/m") /* a screw */                                               \
  FIELD(T, axial_rigidity, "legs.stiffness_law.axial_rigidity", "N")                                             \
  FIELD(T, zero_length, "legs.stiffness_law.zero_length", "m")                                                   \
  FIELD(T, bulk_modulus, "legs.stiffness_law.bulk_modulus", "Pa") /* columns of oil */                           \
  FIELD(T, area_1, "legs.stiffness_law.area_1", "m2")                                                            \
  FIELD(T, area_2, "legs.stiffness_law.area_2", "m2")                                                            \
  FIELD(T, dead_1, "legs.stiffness_law.dead_1", "m")                                                             \
  FIELD(T, dead_2, "legs.stiffness_law.dead_2", "m")                                                             \
  FIELD(T, stroke, "legs.stiffness_law.stroke", "m")                                                             \
  FIELD(T, shortest, "legs.stiffness_law.shortest", "m")

#define FLEXAPOD_SPRING_FIELDS(FIELD)                                                                                \
  FIELD(T, law, "legs.stiffness_law.kind", "")          /* a `Law`; in another than constant, legs.stiffness is 1 */ \
  FIELD(T, table_count, "legs.stiffness_law.count", "") /* nodes in use; the others repeat the last of them */       \
  FIELD(Nodes<T>, table_lengths, "legs.stiffness_law.lengths", "m")                                                  \
  FIELD(Nodes<T>, table_stiffnesses, "legs.stiffness_law.stiffnesses", "N/m")                                        \
  FIELD(Vec3<T>, rest_position, "legs.joint_rest.position", "m") /* where joints and suspension are unstressed */    \
  FIELD(Mat3<T>, rest_matrix, "legs.joint_rest.matrix", "")                                                          \
  FIELD(Vec3<T>, suspension_point, "suspension.point", "m")        /* platform frame */                              \
  FIELD(Sym6<T>, suspension_stiffness, "suspension.stiffness", "") /* base axes; translation m, rotation rad */      \
  FIELD(Sym6<T>, suspension_damping, "suspension.damping", "")

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

template <class T> struct LegSprings {
  FLEXAPOD_LEG_SPRING_FIELDS(FLEXAPOD_MEMBER)
};

/// First the numbers of a machine whose only springs are constant ones along the legs, then those of other springs.
template <class T> struct Design {
  FLEXAPOD_DESIGN_FIELDS(FLEXAPOD_MEMBER)
  Leg<T> leg[6];
  LegSprings<T> springs[6];
  FLEXAPOD_SPRING_FIELDS(FLEXAPOD_MEMBER)
};

inline constexpr int design_size = sizeof(Design<double>) / sizeof(double);
inline constexpr int plain_size = offsetof(Design<double>, springs) / sizeof(double);

/// How many of a design's numbers can matter: `plain_size` where it has no other springs.
inline int used_size(const Design<double>& d) {
  bool used = d.law != 0;
  for (const LegSprings<double>& s : d.springs)
    used |= s.series_compliance != 0 || s.k_u[0] != 0 || s.k_u[1] != 0 || s.k_s != 0 || s.k_t != 0;
  for (int i = 0; i < 21; ++i) used |= d.suspension_stiffness.a[i] != 0 || d.suspension_damping.a[i] != 0;
  return used ? design_size : plain_size;
}

/// Every field of a design, in the order of its numbers.
inline constexpr auto design_layout = [] {
  using T = double;
  constexpr std::size_t leg = offsetof(Design<T>, leg);
  constexpr int stride = sizeof(Leg<T>) / sizeof(T);
  constexpr std::size_t springs = offsetof(Design<T>, springs);
  constexpr int springs_stride = sizeof(LegSprings<T>) / sizeof(T);
#define FLEXAPOD_OF_DESIGN(type, member, key, unit) field<type>(key, offsetof(Design<T>, member), unit),
#define FLEXAPOD_OF_LEG(type, member, key, unit) field<type>(key, leg + offsetof(Leg<T>, member), unit, stride),
#define FLEXAPOD_OF_LOWER(type, member, key, unit) FLEXAPOD_OF_LEG(type, lower.member, key, unit)
#define FLEXAPOD_OF_UPPER(type, member, key, unit) FLEXAPOD_OF_LEG(type, upper.member, key, unit)
#define FLEXAPOD_OF_SPRINGS(type, member, key, unit) \
  field<type>(key, springs + offsetof(LegSprings<T>, member), unit, springs_stride),
  return std::array{FLEXAPOD_DESIGN_FIELDS(FLEXAPOD_OF_DESIGN) FLEXAPOD_LEG_FIELDS(FLEXAPOD_OF_LEG)
                        FLEXAPOD_LEG_PART_FIELDS(FLEXAPOD_OF_LOWER, "legs.lower.") FLEXAPOD_LEG_PART_FIELDS(
                            FLEXAPOD_OF_UPPER, "legs.upper.") FLEXAPOD_LEG_SPRING_FIELDS(FLEXAPOD_OF_SPRINGS)
                            FLEXAPOD_SPRING_FIELDS(FLEXAPOD_OF_DESIGN)};
#undef FLEXAPOD_OF_DESIGN
#undef FLEXAPOD_OF_LEG
#undef FLEXAPOD_OF_LOWER
#undef FLEXAPOD_OF_UPPER
#undef FLEXAPOD_OF_SPRINGS
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

}  // namespace flexapod
