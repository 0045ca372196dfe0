// The closed-form equations of motion of platform and legs on a moving base (Eq. 34):
//     J_p [a; alpha] - J_b [a_b; alpha_b] + eta = H F + [R F_ext; R M_ext].
#pragma once

#include "model/joint_springs.hpp"
#include "model/machine.hpp"
#include "model/suspension.hpp"

namespace flexapod {

/// Where the legs are: vectors in the axes of the poses given.
/// P is the type of the platform joints: in the platform's own axes they are constants of the design.
template <class T, class P = T> struct Geometry {
  Vec3<P> q_p[6];  // joints from the reference points of the platform
  Vec3<T> q_b[6];  // and of the base
  Vec3<T> S[6];    // legs, base joint to platform joint (Eq. 6)
  Vec3<T> k[6];    // universal axes

  template <class D> Geometry(const Design<D>& d, const Pose<T>& platform, const Pose<T>& base) {
    const Vec3<T> t = platform.t - base.t;
    for (int i = 0; i < 6; ++i) {
      q_p[i] = platform.R * d.p[i];
      q_b[i] = base.R * d.b[i];
      S[i] = t + q_p[i] - q_b[i];
      k[i] = base.R * d.k[i];
    }
  }
  /// In the platform's axes, for a base given in them. d: a design, or what has its places.
  template <class D>
  Geometry(const D& d, const Pose<T>& base) : Geometry(d, base, std::make_integer_sequence<int, 6>()) {}

 private:
  template <class D, int... i>
  Geometry(const D& d, const Pose<T>& base, std::integer_sequence<int, i...>)
      : q_p{d.p[i]...}, q_b{base.R * d.b[i]...}, S{(q_p[i] - q_b[i] - base.t)...}, k{base.R * d.k[i]...} {}
};

/// A leg's column of H: the wrench on the platform of a unit force in the leg, [s; q_p x s].
template <class T, class P> Vec6<T> leg_wrench(const Vec3<P>& q_p, const Vec3<T>& s) {
  return Vec6<T>::of(s, cross(q_p, s));
}

/// H: leg forces to the wrench on the platform.
template <class T> Mat6<T> force_transformation(const Geometry<T>& g) {
  Mat6<T> H;
  for (int i = 0; i < 6; ++i) {
    const Vec6<T> h = leg_wrench(g.q_p[i], rsqrt(dot(g.S[i], g.S[i])) * g.S[i]);
    for (int r = 0; r < 6; ++r) H[r][i] = h[r];
  }
  return H;
}

/// J_plat of Eq. 34, in the axes of R. d: a design, or what has its platform.
template <class T, class D> SpatialInertia<T> platform_inertia(const D& d, const Mat3<T>& R) {
  const Vec3<T> R_p = R * d.R_0;
  const T M(d.M), zero(0.0);
  SpatialInertia<T> J;
  J.add(R_p, Sym3<T>{M, M, M, zero, zero, zero});
  J.bottom = J.bottom + rotate(R, d.I_p);
  return J;
}

/// J_p_i of Eq. 34: the inertia of a leg, whose platform joint is at q_p, seen at the platform's reference point.
template <class T, class D, class P>
void add_leg_inertia(SpatialInertia<T>& J, const LegAxes<T>& leg, const LegInertia<D>& in, const Vec3<P>& q_p) {
  J.add(q_p, rotate(transpose(leg.axes), leg_inertia(leg, in)));
}
template <class T, class D>
void add_leg_inertia(SpatialInertia<T>& J, const Machine<D>& machine, const Geometry<T>& g, int i) {
  add_leg_inertia(J, LegAxes<T>(g.S[i], g.k[i], machine.joint), machine.inertia[i], g.q_p[i]);
}

/// J_p of Eq. 34: the inertia of platform and legs seen at the platform's reference point.
template <class T, class D> Mat6<T> inertia(const Machine<D>& machine, const Geometry<T>& g, const Mat3<T>& R) {
  SpatialInertia<T> J = platform_inertia(machine.design, R);
  for (int i = 0; i < 6; ++i) add_leg_inertia(J, machine, g, i);
  return J.matrix();
}

/// A leg's part of J_b, for its joints at q_p and q_b.
template <class T, class D>
void add_base_coupling(Mat6<T>& J, const LegAxes<T>& leg, const LegInertia<D>& inertia, const Vec3<T>& q_p,
                       const Vec3<T>& q_b, Joint joint) {
  const LegInertiaMatrices<T> in = leg_inertia_matrices(leg, inertia);
  const Mat3<T> Q_b = transpose(leg.axes) * (in.Q_b * leg.axes);
  const Vec3<T> spin_force = transposed(leg.axes, in.spin);
  const Vec3<T> spin = joint == Joint::universal ? leg.s() - leg.tau * leg.axes.row[2] : Vec3<T>();  // n / (n.s)
  const T force[3] = {spin_force.x, spin_force.y, spin_force.z};
  Vec6<T> top[3];
  for (int r = 0; r < 3; ++r) top[r] = Vec6<T>::of(Q_b.row[r], cross(q_b, Q_b.row[r]) - force[r] * spin);
  for (int j = 0; j < 6; ++j) {
    const Vec3<T> column(top[0][j], top[1][j], top[2][j]);
    const Vec6<T> both = Vec6<T>::of(column, cross(q_p, column));
    for (int r = 0; r < 6; ++r) J[r][j] += both[r];
  }
}

/// J_b of Eq. 34: how acceleration of the base enters. In the exact joint model a turning base also spins the legs.
template <class T, class D> Mat6<T> base_coupling(const Machine<D>& machine, const Geometry<T>& g) {
  Mat6<T> J;
  for (int i = 0; i < 6; ++i)
    add_base_coupling(J, LegAxes<T>(g.S[i], g.k[i], machine.joint), machine.inertia[i], g.q_p[i], g.q_b[i],
                      machine.joint);
  return J;
}

/// The ends of a leg whose joints are at q_p and q_b, resolved in its axes, with the accelerations of the motions given.
template <class T, class U, class G>
LegEnds<T> leg_ends(const LegAxes<T>& leg, const Vec3<T>& q_p, const Vec3<T>& q_b, const Motion<U>& platform,
                    const Motion<U>& base, const Vec3<G>& gravity) {
  LegEnds<T> end;
  end.v = leg.axes * (platform.velocity_at(q_p) - base.velocity_at(q_b));
  end.a_p = leg.axes * (platform.acceleration_at(q_p) - gravity);
  end.a_b = leg.axes * (base.acceleration_at(q_b) - gravity);
  end.omega_p = leg.axes * platform.w;
  end.omega_b = leg.axes * base.w;
  end.alpha_b = leg.axes * base.alpha;
  return end;
}
template <class T, class D>
LegEnds<T> leg_ends(const Machine<D>& machine, const Geometry<T>& g, const LegAxes<T>& leg, int i,
                    const Motion<T>& platform, const Motion<T>& base) {
  return leg_ends(leg, g.q_p[i], g.q_b[i], platform, base, machine.design.gravity);
}

/// The platform's own part of the wrench below.
template <class T, class D> Vec6<T> platform_wrench(const Design<D>& d, const Motion<T>& platform) {
  const Vec3<T> R_p = platform.pose.R * d.R_0;
  const Vec3<T> f = d.M * (platform.acceleration_at(R_p) - d.gravity);
  const Sym3<T> I = rotate(platform.pose.R, d.I_p);
  return Vec6<T>::of(f, cross(R_p, f) + I * platform.alpha + cross(platform.w, I * platform.w));
}

/// Inertia, weight and friction of platform and legs, springs of joints and a suspension as a wrench at the reference
/// point, for the motions given: J_p [a; alpha] - J_b [a_b; alpha_b] + eta. With all accelerations zero it is eta.
template <class T, class D>
Vec6<T> inverse_wrench(const Machine<D>& machine, const Geometry<T>& g, const Motion<T>& platform,
                       const Motion<T>& base) {
  Vec6<T> wrench = platform_wrench(machine.design, platform);
  for (int i = 0; i < 6; ++i) {
    const LegAxes<T> leg(g.S[i], g.k[i], machine.joint);
    const LegEnds<T> end = leg_ends(machine, g, leg, i, platform, base);
    SphericalLoad<T> load =
        spherical_load(leg, machine.inertia[i], machine.design.leg[i], end, LegMotion<T>(leg, end, machine.joint));
    if (machine.features.joints)
      add_joint_springs(load, machine.design.springs[i], machine.rest[i], leg, g.k[i], platform.pose.R, base.pose.R,
                        machine.joint);
    const Vec3<T> force = transposed(leg.axes, load.force), moment = transposed(leg.axes, load.moment);
    add(wrench, force, cross(g.q_p[i], force) - moment);
  }
  if (machine.features.suspension) add_suspension_load(wrench, machine.design, platform, base);
  return wrench;
}

/// [R F; R M]: a force and moment given in the platform's frame, as a wrench in inertial axes.
template <class T> Vec6<T> external_wrench(const Mat3<T>& R, const Vec6<double>& load) {
  return Vec6<T>::of(R * load.top(), R * load.bottom());
}

/// Leg forces that give the accelerations of `platform` under an external wrench, from H F = wrench; NaN where H is
/// singular.
inline Vec6<double> inverse_dynamics(const Machine<double>& machine, const Geometry<double>& g,
                                     const Motion<double>& platform, const Motion<double>& base,
                                     const Vec6<double>& external) {
  Vec6<double> needed = inverse_wrench(machine, g, platform, base), F;
  for (int j = 0; j < 6; ++j) needed[j] -= external[j];
  if (!solve_general(force_transformation(g), needed, F))
    for (double& force : F.a) force = std::numeric_limits<double>::quiet_NaN();
  return F;
}

template <class T> Motion<T> unaccelerated(Motion<T> motion) {
  motion.a = motion.alpha = Vec3<T>();
  return motion;
}

}  // namespace flexapod
