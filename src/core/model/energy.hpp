// Energy and its loss, for balances.
#pragma once

#include "model/springs.hpp"

namespace flexapod {

struct Energy {
  double kinetic = 0, gravitational = 0;        // J
  double legs = 0, joints = 0, suspension = 0;  // in springs along the legs, of joints, and of the suspension, J
  double dissipation = 0;                       // power lost in the joints and in the suspension, W
};

/// Kinetic energy of a body with mass m, mass times mass centre c and inertia J about a point moving at v.
inline double kinetic_energy(double m, const Vec3<double>& c, const Sym3<double>& J, const Vec3<double>& v,
                             const Vec3<double>& w) {
  return 0.5 * m * dot(v, v) + dot(v, cross(w, c)) + 0.5 * dot(w, J * w);
}

/// Of platform and legs; gravitational energy is zero at the inertial origin. L_0: unstretched lengths of the legs.
inline Energy energy(const Machine<double>& machine, const Motion<double>& platform, const Motion<double>& base,
                     const double (&L_0)[6]) {
  const Design<double>& d = machine.design;
  const Geometry<double> g(d, platform.pose, base.pose);
  const Vec3<double> R_p = platform.pose.R * d.R_0;
  Energy e;
  e.legs = axial_energy(machine, g, L_0);
  e.kinetic = kinetic_energy(d.M, {}, rotate(platform.pose.R, d.I_p), platform.velocity_at(R_p), platform.w);
  e.gravitational = -d.M * dot(d.gravity, platform.pose.t + R_p);
  for (int i = 0; i < 6; ++i) {
    const LegAxes<double> leg(g.S[i], g.k[i], machine.joint);
    const LegInertia<double>& in = machine.inertia[i];
    const LegEnds<double> end = leg_ends(machine, g, leg, i, platform, base);
    const LegMotion<double> motion(leg, end, machine.joint);
    const Vec3<double> v_d = leg.axes * base.velocity_at(g.q_b[i]), v_u = leg.axes * platform.velocity_at(g.q_p[i]);
    const double m_d = d.leg[i].lower.mass;
    e.kinetic += kinetic_energy(m_d, in.c_d, in.J_d, v_d, motion.omega);
    e.kinetic += kinetic_energy(in.m_u, in.c_u, in.J_u, v_u, motion.omega);
    const Vec3<double> weighted =
        m_d * (base.pose.t + g.q_b[i]) + in.m_u * (platform.pose.t + g.q_p[i]) + transposed(leg.axes, in.c_d + in.c_u);
    e.gravitational -= dot(d.gravity, weighted);
    e.dissipation += friction_power(d.leg[i], joint_rates(end, motion));
    if (machine.features.joints)
      e.joints +=
          JointSprings<double>(d.springs[i], machine.rest[i], leg, g.k[i], platform.pose.R, base.pose.R, machine.joint)
              .energy(d.springs[i]);
  }
  if (machine.features.suspension) {
    e.suspension = suspension_energy(d, platform.pose, base.pose);
    e.dissipation += suspension_loss(d, platform, base);
  }
  return e;
}

}  // namespace flexapod
