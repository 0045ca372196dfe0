// One leg: a universal joint on the base, a prismatic pair, a spherical joint on the platform.
//
// Everything about a leg is worked out in its own axes x = s, y = k x s / |k x s|, z = x x y. There the map from the
// velocity of the platform joint relative to the base joint to the leg's angular velocity,
//     W = P s~ / L,   P = E - s n^T / (n.s),   n = k x y        (corrections, part B),
// has the columns 0, w_2 = (tau, 0, 1)/L and w_3 = (0, -1, 0)/L with tau = (k.s)/|k x s|; the paper's model has tau = 0.
#pragma once

#include "model/friction.hpp"
#include "model/motion.hpp"

namespace flexapod {

/// A leg's length, axes and obliquity.
template <class T> struct LegAxes {
  T L, u;        // length and its reciprocal
  Mat3<T> axes;  // rows s, y, z in the axes of the vectors given
  T cosecant;    // of the angle between leg and universal axis
  T tau;         // its cotangent; zero in the paper's model

  /// S: vector from base joint to platform joint (Eq. 6); k: the universal joint's axis in the base.
  template <class U> LegAxes(const Vec3<T>& S, const Vec3<U>& k, Joint joint) {
    const T L2 = dot(S, S);
    u = rsqrt(L2);
    L = L2 * u;
    const Vec3<T> s = u * S, k_x_s = cross(k, s);
    cosecant = rsqrt(dot(k_x_s, k_x_s));
    const Vec3<T> y = cosecant * k_x_s;
    axes = {{s, y, cross(s, y)}};
    tau = joint == Joint::universal ? dot(k, s) * cosecant : T(0.0);
  }
  const Vec3<T>& s() const { return axes.row[0]; }

  /// W v: angular velocity from the relative velocity v of the joints (leg axes).
  template <class V = T> Vec3<product_t<T, V>> W(const Vec3<V>& v) const {
    return {tau * u * v.y, -(u * v.z), u * v.y};
  }
  /// W^T m: the force at the platform joint that balances a moment m about the base joint.
  template <class V> Vec3<product_t<T, V>> W_transposed(const Vec3<V>& m) const {
    return {product_t<T, V>(0.0), u * (tau * m.x + m.z), -(u * m.y)};
  }
};

/// Q_p and Q_b of one leg (Eqs 24, 25; corrections E1, E2) in leg axes, and the reaction of its spin.
template <class T> struct LegInertiaMatrices {
  Sym3<T> Q_p;
  Mat3<T> Q_b;
  Vec3<T> spin;  // force at the platform joint for a unit angular acceleration about the leg's own axis
};

/// With masses taken about the joints the partial velocities of corrections part A collapse to
///     Q_p = m_u E + X_u + X_u^T + W^T J W,   Q_b = W^T J W + X_u - X_d^T,   X = -c~ W.
template <class T, class D> Sym3<T> leg_inertia(const LegAxes<T>& leg, const LegInertia<D>& in) {
  const T u = leg.u, u2 = u * u, tau = leg.tau;
  const auto& c = in.c_u;
  const auto& J = in.J;
  Sym3<T> Q;
  Q.xx = T(in.m_u);
  Q.xy = -(u * c.y);
  Q.xz = -(u * c.z);
  Q.yy = in.m_u + 2.0 * u * (c.x - tau * c.z) + u2 * (J.zz + tau * (2.0 * J.xz + tau * J.xx));
  Q.yz = u * (tau * c.y) - u2 * (J.yz + tau * J.xy);
  Q.zz = in.m_u + 2.0 * u * c.x + u2 * J.yy;
  return Q;
}

template <class T, class D> LegInertiaMatrices<T> leg_inertia_matrices(const LegAxes<T>& leg, const LegInertia<D>& in) {
  LegInertiaMatrices<T> result;
  result.Q_p = leg_inertia(leg, in);
  const T one(1.0), zero(0.0);
  const Vec3<T> w[3] = {{zero, zero, zero}, leg.W({zero, one, zero}), leg.W({zero, zero, one})};
  T Q[3][3];
  for (int j = 0; j < 3; ++j) {
    const Vec3<T> column = cross(w[j], in.c_u) + leg.W_transposed(in.J * w[j]);  // W^T J W + X_u
    Q[0][j] = column.x, Q[1][j] = column.y, Q[2][j] = column.z;
  }
  for (int i = 0; i < 3; ++i) {
    const Vec3<T> x = cross(w[i], in.c_d);  // row i of X_d^T
    result.Q_b.row[i] = Vec3<T>(Q[i][0], Q[i][1], Q[i][2]) - x;
  }
  const Vec3<T> s(one, zero, zero);
  result.spin = cross(s, in.c_u) + leg.W_transposed(in.J * s);
  return result;
}

/// How the ends of a leg move, in leg axes: the two joints, base and platform.
template <class T> struct LegEnds {
  Vec3<T> v;                          // velocity of the platform joint relative to the base joint
  Vec3<T> a_p, a_b;                   // accelerations of the platform joint and the base joint, gravity subtracted
  Vec3<T> omega_p, omega_b, alpha_b;  // of platform and base
};

/// The leg's own motion, in leg axes.
template <class T> struct LegMotion {
  Vec3<T> omega, omega_rel;  // angular velocity, and that relative to the base
  Vec3<T> A;                 // angular acceleration

  template <class U> LegMotion(const LegAxes<U>& leg, const LegEnds<T>& end, Joint joint) {
    const U tau = leg.tau, u = leg.u;
    const Vec3<T>& w_b = end.omega_b;
    const bool universal = joint == Joint::universal;
    omega = leg.W(end.v);
    if (universal) omega.x += w_b.x - tau * w_b.z;  // s (n.w_b)/(n.s): a turning base spins its legs
    omega_rel = omega - w_b;
    const Vec3<T> S2 = end.a_p - end.a_b;  // Eq. 12
    const T L_dot = end.v.x;
    A.y = omega.x * omega.z - u * (S2.z + 2.0 * L_dot * omega.y);
    A.z = u * (S2.y - 2.0 * L_dot * omega.z) - omega.x * omega.y;
    A.x = universal ? end.alpha_b.x + tau * (A.z - end.alpha_b.z) + (tau * omega_rel.x + omega_rel.z) * w_b.y -
                          omega_rel.y * (omega.z + tau * omega.x)
                    : T(0.0);
  }
};

template <class T> JointRates<T> joint_rates(const LegEnds<T>& end, const LegMotion<T>& motion) {
  return {end.v.x, motion.omega_rel, motion.omega - end.omega_p};
}

/// What the leg's spherical joint carries for a given motion, in leg axes.
template <class T> struct SphericalLoad {
  Vec3<T> force;   // F_s, on the leg by the platform (Eq. 23), for no actuator force
  Vec3<T> moment;  // f, friction moment
};

/// F_s = f_u + W^T [N + f_universal + f_spherical] + s f_prismatic, with f_u the upper part's inertia and weight force,
/// N both parts' inertia and weight moments about their joints, and the joints' friction (Eqs 20-23; corrections E3, E4,
/// part B).
template <class T, class D, class E>
SphericalLoad<T> spherical_load(const LegAxes<T>& leg, const LegInertia<D>& in, const Leg<E>& parts,
                                const LegEnds<T>& end, const LegMotion<T>& motion) {
  const Vec3<T>&A = motion.A, &w = motion.omega;
  const Vec3<T> f_u = in.m_u * end.a_p + cross(A, in.c_u) + cross(w, cross(w, in.c_u));
  const Vec3<T> N = cross(in.c_d, end.a_b) + cross(in.c_u, end.a_p) + in.J * A + cross(w, in.J * w);
  const JointFriction<T> friction(parts, joint_rates(end, motion));
  SphericalLoad<T> load;
  load.moment = friction.spherical;
  load.force = f_u + leg.W_transposed(N + friction.universal + friction.spherical);
  load.force.x += friction.prismatic;
  return load;
}

/// The same of a leg at rest; a: acceleration against gravity, in leg axes.
template <class T, class D>
SphericalLoad<T> weight_load(const LegAxes<T>& leg, const LegInertia<D>& in, const Vec3<T>& a) {
  return {in.m_u * a + leg.W_transposed(cross(in.c_d + in.c_u, a)), Vec3<T>()};
}

/// How the force of `weight_load` changes with the place of the platform joint: one row for each of the leg's axes, along
/// which the joint moves while the axes turn. cotangent: of the angle between leg and universal axis.
template <class T, class D>
Mat3<T> weight_stiffness(const LegAxes<T>& leg, const LegInertia<D>& in, const Vec3<T>& a, const T& cotangent,
                         Joint joint) {
  const T u = leg.u, zero(0.0), slant = u * leg.cosecant;  // tau changes by slant^2 / u along z
  const auto c = in.c_d + in.c_u;
  const Vec3<T> N = cross(c, a), force = leg.W_transposed(N);
  const auto turned = [&](const Vec3<T>& by) { return cross(by, force) + leg.W_transposed(cross(c, cross(a, by))); };
  Vec3<T> along_z = turned({zero, -u, zero});
  if (joint == Joint::universal) along_z.y += slant * slant * N.x;
  return {{-u * force, turned({cotangent * u, zero, u}), along_z}};
}

/// The part of `spherical_load` that friction has.
template <class T, class U, class E>
SphericalLoad<T> friction_load(const LegAxes<U>& leg, const Leg<E>& parts, const LegEnds<T>& end,
                               const LegMotion<T>& motion) {
  const JointFriction<T> friction(parts, joint_rates(end, motion));
  SphericalLoad<T> load{leg.W_transposed(friction.universal + friction.spherical), friction.spherical};
  load.force.x += friction.prismatic;
  return load;
}

}  // namespace flexapod
