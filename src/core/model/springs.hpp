// The springs of a machine. Spring j has a stiffness k_j and a direction d_j: the wrench on the platform when it pushes
// with unit force, so that a small twist x of the platform lengthens it by d_j . x. The columns sqrt(k_j) d_j form F, and
// the stiffness of the unloaded machine at the platform is K = F F^T.
//
// Springs 0 to 5 are those along the legs: their directions are the columns of H. Where a machine has springs in its
// joints or a suspension, five for each leg (`joint_springs.hpp`) and six (`suspension.hpp`) come after them.
#pragma once

#include "model/equations.hpp"

namespace flexapod {

inline constexpr int spring_count = 6;  // along the legs
inline constexpr int joint_spring_count = 6 * springs_of_joints;
inline constexpr int all_springs = spring_count + joint_spring_count + 6;

/// One column for each spring along a leg.
template <class T> using SpringMatrix = Mat6<T, spring_count>;

/// The leg that a spring belongs to; -1 for the suspension.
inline constexpr int spring_leg(int j) {
  return j < spring_count ? j : j < spring_count + joint_spring_count ? (j - spring_count) / springs_of_joints : -1;
}

/// Sets the directions of the springs of leg i, whose platform joint is at q_p.
template <class T, class P>
void set_spring_directions(SpringMatrix<T>& directions, int i, const Vec3<P>& q_p, const LegAxes<T>& leg) {
  const Vec6<T> h = leg_wrench(q_p, leg.s());
  for (int r = 0; r < 6; ++r) directions[r][i] = h[r];
}
/// The same where nobody has the leg's axes, of which springs along the legs need the first only.
template <class T, class P> void set_spring_directions(SpringMatrix<T>& directions, int i, const Geometry<T, P>& g) {
  const Vec6<T> h = leg_wrench(g.q_p[i], rsqrt(dot(g.S[i], g.S[i])) * g.S[i]);
  for (int r = 0; r < 6; ++r) directions[r][i] = h[r];
}

template <class T> SpringMatrix<T> spring_directions(const Geometry<T>& g) {
  SpringMatrix<T> directions;
  for (int i = 0; i < 6; ++i) set_spring_directions(directions, i, g);
  return directions;
}

/// Calls f with the axial stiffness of the six legs: numbers of the machine where they are constant, else of the pose.
template <class T, class D, class P, class F>
decltype(auto) with_stiffness(const Machine<D>& machine, const Geometry<T, P>& g, F&& f) {
  if (machine.features.law == Law::constant) return f(machine.axial.constant);
  T k[spring_count];
  for (int i = 0; i < spring_count; ++i) k[i] = machine.stiffness(i, T(norm(g.S[i])));
  return f(k);
}

/// Square roots of the stiffnesses along the legs.
template <class D> struct RootStiffness {
  D root[spring_count];

  RootStiffness() = default;
  explicit RootStiffness(const D (&k)[spring_count]) {
    for (int j = 0; j < spring_count; ++j) root[j] = sqrt(k[j]);
  }
  /// Their columns of F.
  template <class T> SpringMatrix<T> scaled(const SpringMatrix<T>& directions) const {
    SpringMatrix<T> F;
    for (int r = 0; r < 6; ++r)
      for (int j = 0; j < spring_count; ++j) F[r][j] = root[j] * directions[r][j];
    return F;
  }
};

/// The columns of F along the legs at a pose.
template <class T> SpringMatrix<T> leg_spring_matrix(const Machine<T>& machine, const Geometry<T>& g) {
  return with_stiffness(machine, g, [&](const T(&k)[6]) { return RootStiffness<T>(k).scaled(spring_directions(g)); });
}

/// F with the columns of all springs. R_p, R_b: of platform and base.
inline Mat6<double, all_springs> spring_matrix(const Machine<double>& machine, const Geometry<double>& g,
                                               const Mat3<double>& R_p, const Mat3<double>& R_b) {
  Mat6<double, all_springs> F;
  const SpringMatrix<double> along = leg_spring_matrix(machine, g);
  const Mat6<double> C = suspension_root(machine.design);
  const Vec3<double> p = R_p * machine.design.suspension_point;
  for (int i = 0; i < 6; ++i) {
    const JointDirections<double> joint(LegAxes<double>(g.S[i], g.k[i], machine.joint), g.q_p[i], machine.joint);
    Vec6<double> column;
    for (int r = 0; r < 6; ++r) column[r] = C[r][i];
    column = suspension_wrench_at(R_b, p, column);
    for (int r = 0; r < 6; ++r) {
      F[r][i] = along[r][i], F[r][spring_count + joint_spring_count + i] = column[r];
      for (int j = 0; j < springs_of_joints; ++j)
        F[r][spring_count + springs_of_joints * i + j] =
            std::sqrt(joint_stiffness(machine.design.springs[i], j)) * joint.d[j][r];
    }
  }
  return F;
}

/// Of springs beside those along the legs: K = sum k d d^T. R_p, R_b: of platform and base.
template <class T, class D, class P>
void add_other_stiffness(SpatialInertia<T>& K, const Machine<D>& machine, const Geometry<T, P>& g, const Mat3<T>& R_p,
                         const Mat3<T>& R_b) {
  if (machine.features.joints)
    for (int i = 0; i < 6; ++i)
      add_joint_stiffness(K, LegAxes<T>(g.S[i], g.k[i], machine.joint), machine.design.springs[i], g.q_p[i],
                          machine.joint);
  if (machine.features.suspension) add_suspension(K, machine.design, R_p, R_b);
}

/// K = D diag(k) D^T of the springs along the legs.
template <class T, class D> Mat6<T> stiffness_matrix(const D (&k)[spring_count], const SpringMatrix<T>& directions) {
  Mat6<T> K;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c <= r; ++c) {
      for (int j = 0; j < spring_count; ++j) K[r][c] += k[j] * (directions[r][j] * directions[c][j]);
      K[c][r] = K[r][c];
    }
  return K;
}

/// How much each spring along a leg is longer than when it carries no force, m; L_0: the legs' unstretched lengths.
template <class T> void elongations(const Geometry<T>& g, const double (&L_0)[6], T (&elongation)[spring_count]) {
  for (int i = 0; i < 6; ++i) elongation[i] = norm(g.S[i]) - L_0[i];
}

/// The wrench of the springs along the legs on the platform, -D K e.
template <class T> Vec6<T> spring_wrench(const Machine<double>& machine, const Geometry<T>& g, const double (&L_0)[6]) {
  const SpringMatrix<T> directions = spring_directions(g);
  T elongation[spring_count];
  elongations(g, L_0, elongation);
  Vec6<T> wrench;
  for (int j = 0; j < spring_count; ++j) {
    const T push = -(machine.stiffness(j, L_0[j]) * elongation[j]);
    for (int r = 0; r < 6; ++r) wrench[r] += directions[r][j] * push;
  }
  return wrench;
}

/// The energy in the springs along the legs, J.
inline double axial_energy(const Machine<double>& machine, const Geometry<double>& g, const double (&L_0)[6]) {
  double elongation[spring_count], energy = 0;
  elongations(g, L_0, elongation);
  for (int j = 0; j < spring_count; ++j) energy += 0.5 * machine.stiffness(j, L_0[j]) * elongation[j] * elongation[j];
  return energy;
}

/// The unstretched length at which a leg of length L pushes with the force F: k(L_0) (L_0 - L) = F. NaN where the law of
/// its stiffness has none.
inline double unstretched_length(const Machine<double>& machine, int i, double L, double F) {
  using D = Dual<1>;
  double L_0 = L + F / machine.stiffness(i, L);
  if (machine.features.law == Law::constant) return L_0;
  for (int step = 0; step < 50; ++step) {
    const D length = D::variable(L_0, 0), force = machine.stiffness(i, length) * (length - L);
    const double change = (F - force.v) / force.d[0];
    if (!(std::abs(change) > 1e-12 * L)) return L_0 + change;
    L_0 += change;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The force of a constant spring along a leg that is shorter by `compression`, N.
template <class T> T axial_force(const Leg<T>& leg, const T& compression) { return leg.stiffness * compression; }

/// a^T K b for two twists of the platform by which the springs along the legs change by the rates a and b.
template <class D, class T>
T stiffness_product(const D (&k)[spring_count], const T (&a)[spring_count], const T (&b)[spring_count]) {
  T sum = k[0] * (a[0] * b[0]);
  for (int j = 1; j < spring_count; ++j) sum += k[j] * (a[j] * b[j]);
  return sum;
}

/// D^T v: how a twist of the platform changes the springs along the legs.
template <class T, class U>
void spring_rates(const SpringMatrix<T>& directions, const Vec6<U>& twist, T (&rate)[spring_count]) {
  for (int j = 0; j < spring_count; ++j) {
    rate[j] = T(0.0);
    for (int r = 0; r < 6; ++r) rate[j] += directions[r][j] * twist[r];
  }
}

}  // namespace flexapod
