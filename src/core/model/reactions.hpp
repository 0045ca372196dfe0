// What the joints carry: the forces and moments a designer needs and the paper leaves out (its Section 6).
#pragma once

#include "model/equations.hpp"

namespace flexapod {

/// Forces N and moments N m of one leg, in the axes of the motions given.
template <class T> struct LegReactions {
  Vec3<T> spherical_force, spherical_moment;  // on the platform by the leg, at the platform joint
  Vec3<T> prismatic_force, prismatic_moment;  // on the upper part by the lower part, at the section asked for
  Vec3<T> universal_force, universal_moment;  // on the base by the leg, at the base joint
};

/// For the accelerations in `end`, what the spherical joint carries with them, and the actuator force F that goes with
/// them. `section`: where along the leg the prismatic pair's moment is taken, as a fraction of the leg's length from the
/// base joint.
template <class T>
LegReactions<T> leg_reactions(const Leg<T>& parts, const LegInertia<T>& in, const LegAxes<T>& leg,
                              const LegEnds<T>& end, const LegMotion<T>& motion, SphericalLoad<T> load, const T& F,
                              double section) {
  load.force.x -= F;
  const auto &A = motion.A, &w = motion.omega;
  const T m_d = parts.lower.mass;
  const Vec3<T> f_d = m_d * end.a_b + cross(A, in.c_d) + cross(w, cross(w, in.c_d));
  const Vec3<T> f_u = in.m_u * end.a_p + cross(A, in.c_u) + cross(w, cross(w, in.c_u));
  const Vec3<T> N_d = cross(in.c_d, end.a_b) + in.J_d * A + cross(w, in.J_d * w);
  const Vec3<T> N_u = cross(in.c_u, end.a_p) + in.J_u * A + cross(w, in.J_u * w);
  const Vec3<T> upper = f_u - load.force;      // on the upper part by the lower part
  const Vec3<T> at_joint = N_u + load.moment;  // and its moment about the platform joint
  const auto lever = [&](double fraction) { return cross(Vec3<T>(fraction * leg.L, T(0.0), T(0.0)), upper); };
  const auto out = [&](const Vec3<T>& v) { return transposed(leg.axes, v); };

  LegReactions<T> r;
  r.spherical_force = out(-load.force);
  r.spherical_moment = out(load.moment);
  r.prismatic_force = out(upper);
  r.prismatic_moment = out(at_joint + lever(1.0 - section));
  r.universal_force = out(-(f_d + upper));
  r.universal_moment = out(-(N_d + at_joint + lever(1.0)));
  return r;
}

struct Reactions {
  LegReactions<double> leg[6];
  Vec3<double> base_force, base_moment;  // total on the base, moment about its reference point
};

/// For the accelerations in `platform` and `base` and the actuator forces that go with them.
inline Reactions reactions(const Machine<double>& machine, const Motion<double>& platform, const Motion<double>& base,
                           const Vec6<double>& leg_force, double section) {
  const Geometry<double> g(machine.design, platform.pose, base.pose);
  Reactions result;
  for (int i = 0; i < 6; ++i) {
    const LegAxes<double> leg(g.S[i], g.k[i], machine.joint);
    const LegEnds<double> end = leg_ends(machine, g, leg, i, platform, base);
    const LegMotion<double> motion(leg, end, machine.joint);
    const Leg<double>& parts = machine.design.leg[i];
    SphericalLoad<double> load = spherical_load(leg, machine.inertia[i], parts, end, motion);
    if (machine.features.joints)
      add_joint_springs(load, machine.design.springs[i], machine.rest[i], leg, g.k[i], platform.pose.R, base.pose.R,
                        machine.joint);
    result.leg[i] = leg_reactions(parts, machine.inertia[i], leg, end, motion, load, leg_force[i], section);
    const LegReactions<double>& r = result.leg[i];
    result.base_force += r.universal_force;
    result.base_moment += cross(g.q_b[i], r.universal_force) + r.universal_moment;
  }
  if (machine.features.suspension) {
    const Vec6<double> load = suspension_load(machine.design, platform, base);
    result.base_force += load.top();
    result.base_moment += cross(platform.pose.t - base.pose.t, load.top()) + load.bottom();
  }
  return result;
}

}  // namespace flexapod
