// Friction in the joints of a leg: one law, viscous, from which force and power are taken. A new law, or a new parameter
// of it, belongs here.
#pragma once

#include "model/design.hpp"

namespace flexapod {

/// How fast the joints of a leg move, in leg axes.
template <class T> struct JointRates {
  T prismatic;        // m/s
  Vec3<T> universal;  // of the leg relative to the base, rad/s
  Vec3<T> spherical;  // of the leg relative to the platform, rad/s
};

/// The force (N) and the moments (N m) against these rates.
template <class T> struct JointFriction {
  T prismatic;
  Vec3<T> universal, spherical;

  template <class D>
  JointFriction(const Leg<D>& leg, const JointRates<T>& rate)
      : prismatic(leg.C_p * rate.prismatic), universal(leg.C_u * rate.universal), spherical(leg.C_s * rate.spherical) {}

  /// What is lost at these rates, W.
  T power(const JointRates<T>& rate) const {
    return prismatic * rate.prismatic + dot(universal, rate.universal) + dot(spherical, rate.spherical);
  }
};

/// Power lost in the joints of a leg, W.
template <class T, class D> T friction_power(const Leg<D>& leg, const JointRates<T>& rate) {
  return JointFriction<T>(leg, rate).power(rate);
}

/// Whether any joint has friction.
inline bool has_friction(const Design<double>& design) {
  for (const Leg<double>& leg : design.leg)
    if (leg.C_p > 0 || leg.C_u > 0 || leg.C_s > 0) return true;
  return false;
}

}  // namespace flexapod
