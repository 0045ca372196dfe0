// The springs of a machine. Spring j has a stiffness k_j and a direction d_j: the wrench on the platform when it pushes
// with unit force, so that a small twist x of the platform lengthens it by d_j . x. The columns sqrt(k_j) d_j form F
// (6 x spring_count), and the stiffness of the unloaded machine at the platform is K = F F^T.
//
// Springs 0 to 5 are those along the legs: their directions are the columns of H. Springs of another kind come after
// them. Their number, stiffnesses, directions and elongations are said here; modes, sweeps, gradients, statics and
// energy follow. Simulations take the springs along the legs, in lanes, by `axial_force`.
#pragma once

#include "model/equations.hpp"

namespace flexapod {

inline constexpr int spring_count = 6;

/// One column for each spring.
template <class T> using SpringMatrix = Mat6<T, spring_count>;

/// N/m.
template <class D> const D& spring_stiffness(const Design<D>& design, int j) { return design.leg[j].stiffness; }

/// The leg that a spring belongs to.
inline constexpr int spring_leg(int j) { return j % 6; }

/// Sets the directions of the springs of leg i, whose platform joint is at q_p.
template <class T, class P>
void set_spring_directions(SpringMatrix<T>& directions, int i, const Vec3<P>& q_p, const LegAxes<T>& leg) {
  const Vec6<T> h = leg_wrench(q_p, leg.s());
  for (int r = 0; r < 6; ++r) directions[r][i] = h[r];
}
/// The same where nobody has the leg's axes, of which springs along the legs need the first only.
template <class T, class P>
void set_spring_directions(SpringMatrix<T>& directions, int i, const Geometry<T, P>& g, Joint) {
  const Vec6<T> h = leg_wrench(g.q_p[i], rsqrt(dot(g.S[i], g.S[i])) * g.S[i]);
  for (int r = 0; r < 6; ++r) directions[r][i] = h[r];
}

template <class T> SpringMatrix<T> spring_directions(const Geometry<T>& g, Joint joint) {
  SpringMatrix<T> directions;
  for (int i = 0; i < 6; ++i) set_spring_directions(directions, i, g, joint);
  return directions;
}

/// The legs' columns H of the directions.
template <class T> Mat6<T> leg_directions(const SpringMatrix<T>& directions) {
  if constexpr (spring_count == 6) return directions;
  Mat6<T> H;
  for (int r = 0; r < 6; ++r)
    for (int i = 0; i < 6; ++i) H[r][i] = directions[r][i];
  return H;
}

/// Square roots of all stiffnesses.
template <class D> struct RootStiffness {
  D root[spring_count];

  explicit RootStiffness(const Design<D>& design) {
    for (int j = 0; j < spring_count; ++j) root[j] = sqrt(spring_stiffness(design, j));
  }
  /// F.
  template <class T> SpringMatrix<T> scaled(const SpringMatrix<T>& directions) const {
    SpringMatrix<T> F;
    for (int r = 0; r < 6; ++r)
      for (int j = 0; j < spring_count; ++j) F[r][j] = root[j] * directions[r][j];
    return F;
  }
};

/// K = D diag(k) D^T.
template <class T, class D> Mat6<T> stiffness_matrix(const Design<D>& design, const SpringMatrix<T>& directions) {
  Mat6<T> K;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c <= r; ++c) {
      for (int j = 0; j < spring_count; ++j)
        K[r][c] += spring_stiffness(design, j) * (directions[r][j] * directions[c][j]);
      K[c][r] = K[r][c];
    }
  return K;
}

/// How much each spring is longer than when it carries no force, m; L_0: the legs' unstretched lengths.
template <class T> void elongations(const Geometry<T>& g, const double (&L_0)[6], T (&elongation)[spring_count]) {
  for (int i = 0; i < 6; ++i) elongation[i] = norm(g.S[i]) - L_0[i];
}

/// The wrench of all springs on the platform, -D K e.
template <class T> Vec6<T> spring_wrench(const Machine<double>& machine, const Geometry<T>& g, const double (&L_0)[6]) {
  const SpringMatrix<T> directions = spring_directions(g, machine.joint);
  T elongation[spring_count];
  elongations(g, L_0, elongation);
  Vec6<T> wrench;
  for (int j = 0; j < spring_count; ++j) {
    const T push = -(spring_stiffness(machine.design, j) * elongation[j]);
    for (int r = 0; r < 6; ++r) wrench[r] += directions[r][j] * push;
  }
  return wrench;
}

/// The energy in all springs, J.
inline double elastic_energy(const Machine<double>& machine, const Geometry<double>& g, const double (&L_0)[6]) {
  double elongation[spring_count], energy = 0;
  elongations(g, L_0, elongation);
  for (int j = 0; j < spring_count; ++j)
    energy += 0.5 * spring_stiffness(machine.design, j) * elongation[j] * elongation[j];
  return energy;
}

/// The force of the spring along a leg that is shorter by `compression`, N.
template <class T> T axial_force(const Leg<T>& leg, const T& compression) { return leg.stiffness * compression; }

/// a^T K b for two twists of the platform whose springs change by the rates a and b.
template <class D, class T>
T stiffness_product(const Design<D>& design, const T (&a)[spring_count], const T (&b)[spring_count]) {
  T sum = spring_stiffness(design, 0) * (a[0] * b[0]);
  for (int j = 1; j < spring_count; ++j) sum += spring_stiffness(design, j) * (a[j] * b[j]);
  return sum;
}

/// D^T v: how a twist of the platform changes the springs.
template <class T, class U>
void spring_rates(const SpringMatrix<T>& directions, const Vec6<U>& twist, T (&rate)[spring_count]) {
  for (int j = 0; j < spring_count; ++j) {
    rate[j] = T(0.0);
    for (int r = 0; r < 6; ++r) rate[j] += directions[r][j] * twist[r];
  }
}

}  // namespace flexapod
