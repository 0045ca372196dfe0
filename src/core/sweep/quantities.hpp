// What a sweep can tell of a pack of poses beside frequencies and the condition of H.
#pragma once

#include "decomposition/least_squares.hpp"
#include "model/modes.hpp"
#include "sweep/pose_pack.hpp"

namespace flexapod {

using sweep_task::Quantity;
using sweep_task::Task;

/// Quantities that need no springs.
template <class T> struct RigidQuantities {
  const SweptMachine& machine;
  const Task& task;
  const Rows rows;
  const PosePack<T>& at;

  /// Roll, pitch and yaw of poses that are given by other numbers.
  FLEXAPOD_FLAT void coordinates() const {
    const Vec3<T> angles = roll_pitch_yaw_of(at.pose.R);
    rows.put(task.rpy_, angles.x, 0, 3), rows.put(task.rpy_, angles.y, 1, 3), rows.put(task.rpy_, angles.z, 2, 3);
  }

  void geometry() const {
    const unsigned asked = task.quantities;
    const sweep_task::Limits& limits = *task.limits;
    const auto bad = at.fault > 0.0;
    const bool check = asked & Quantity::within_limits;
    auto within = !bad;
    const auto bound = [&](const T& value, double low, double high) {
      within = within & (value >= low) & (value <= high);
    };
    const bool angles = asked & Quantity::joint_angle;
    const bool limited = limits.universal_angle < 1e300 || limits.spherical_angle < 1e300;
    for (int i = 0; i < 6; ++i) {
      if ((asked & Quantity::leg_length) || check) {
        const T L = norm(at.g.S[i]);
        if (asked & Quantity::leg_length) rows.put(task.leg_length_, unless(bad, L), i, 6);
        if (check) bound(L, limits.length[i][0], limits.length[i][1]);
      }
      if (angles || (check && limited)) {
        const T universal = angle_to(transposed(at.pose.R, direction(limits.neutral[0][i])), i);
        const T spherical = angle_to(direction(limits.neutral[1][i]), i);
        if (angles) rows.put(task.universal_angle_, unless(bad, universal), i, 6);
        if (angles) rows.put(task.spherical_angle_, unless(bad, spherical), i, 6);
        if (check) bound(universal, -1.0, limits.universal_angle), bound(spherical, -1.0, limits.spherical_angle);
      }
    }
    moments(bad, bound);
    if ((asked & Quantity::leg_distance) || (check && limits.leg_distance > -1e300)) {
      const T distance = least_leg_distance(at.g, machine.shared);
      if (asked & Quantity::leg_distance) rows.put(task.leg_distance_, unless(bad, distance));
      if (check) bound(distance, limits.leg_distance, std::numeric_limits<double>::infinity());
    }
    if (check) {
      double yes[T::lanes];
      select(within, T(1.0), T(0.0)).store(yes);
      for (int l = 0; l < rows.count; ++l) task.within_limits_[rows.first + l] = yes[l] != 0.0;
    }
  }

  /// Of the joints' springs: about the two axes of a universal joint together, and where the leg bends at the platform.
  template <class Bound> FLEXAPOD_INLINE void moments(const mask_t<T>& bad, const Bound& bound) const {
    const sweep_task::Limits& limits = *task.limits;
    const bool asked = task.quantities & Quantity::joint_moment;
    const bool check = task.quantities & Quantity::within_limits &&
                       (limits.universal_moment < 1e300 || limits.spherical_moment < 1e300);
    if (!asked && !check) return;
    for (int i = 0; i < 6; ++i) {
      T universal(0.0), spherical(0.0);
      if (machine.machine.features.joints) joint_moments(i, universal, spherical);
      if (asked) rows.put(task.universal_moment_, unless(bad, universal), i, 6);
      if (asked) rows.put(task.spherical_moment_, unless(bad, spherical), i, 6);
      if (check) bound(universal, -1.0, limits.universal_moment), bound(spherical, -1.0, limits.spherical_moment);
    }
  }
  FLEXAPOD_APART void joint_moments(int i, T& universal, T& spherical) const {
    const Machine<double>& m = machine.machine;
    const LegAxes<T> leg(at.g.S[i], at.g.k[i], m.joint);
    const JointSprings<T> springs(m.design.springs[i], m.rest[i], leg, at.g.k[i], Mat3<T>::identity(), at.base().R,
                                  m.joint);
    universal = springs.universal_moment(m.design.springs[i]);
    spherical = springs.spherical_moment(m.design.springs[i]);
  }

  /// The largest leg force at rest: weight is the same as no gravity and an acceleration of everything against it.
  FLEXAPOD_FLAT T static_force() const {
    Motion<T> platform, base;
    platform.a = base.a = -transposed(at.pose.R, machine.machine.design.gravity);
    base.pose = at.base();
    const Geometry<T> g(machine.weightless.design, platform.pose, base.pose);
    Vec6<T> load[1] = {inverse_wrench(machine.weightless, g, platform, base)};
    for (int i = 3; i < 6; ++i) load[0][i] *= 1.0 / machine.size;
    ForceMap<T> legs;
    legs.set_legs(at);
    const T weak = solve(legs.directions, load);
    T most = abs(load[0][0]);
    for (int i = 1; i < 6; ++i) most = max(most, abs(load[0][i]));
    return finish(task.leg_force_, most, weak, at.fault);
  }

  /// Solves A x = b with rows of moments divided by the platform's size; how near A is to singular.
  template <int m> T solve(Mat6<T>& A, Vec6<T> (&b)[m]) const {
    for (int i = 3; i < 6; ++i)
      for (T& a : A.a[i]) a *= 1.0 / machine.size;
    T weak;
    solve_orthogonal(A, b, weak);
    return weak;
  }
  T finish(double* to, const T& value, const T& weak, const T& fault) const {
    const auto hopeless = weak < 1e-13;
    rows.put(to, unless(hopeless | (fault > 0.0), value));
    return worse(hopeless, sweep_task::singular, fault);
  }

 private:
  static Vec3<double> direction(const double (&n)[3]) { return {n[0], n[1], n[2]}; }
  template <class U> T angle_to(const Vec3<U>& n, int i) const {
    const Vec3<T>& S = at.g.S[i];
    return upper_angle(norm(cross(n, S)), dot(n, S));
  }
};

/// Quantities that need no modes, or but one.
template <class T, Swept kind> struct SweepQuantities : RigidQuantities<T> {
  using RigidQuantities<T>::machine, RigidQuantities<T>::task, RigidQuantities<T>::rows, RigidQuantities<T>::at;

  /// Everything that is asked for. A fault that is found is noted where there was none.
  void evaluate(T& fault) const {
    constexpr unsigned geometric = Quantity::leg_length | Quantity::joint_angle | Quantity::joint_moment |
                                   Quantity::leg_distance | Quantity::within_limits;
    const unsigned asked = task.quantities;
    const auto note = [&](const T& found) { fault = select(fault > 0.0, fault, found); };
    if (asked & geometric) this->geometry();
    if (asked & Quantity::rpy) this->coordinates();
    if (asked & Quantity::leg_force) note(this->static_force());
    if (asked & Quantity::lowest_stiffness) note(stiffness());
    if (asked & Quantity::omega_1_gradient) note(gradient());
  }

  /// The least translational stiffness: 1 / largest eigenvalue of the block of translations of K^-1, which is Y^T Y with
  /// Y = F^-1 [E; 0] for a square F.
  FLEXAPOD_FLAT T stiffness() const {
    Vec6<T> side[3];
    for (int i = 0; i < 3; ++i) side[i][i] = T(1.0);
    MassAndForceMap<T, kind> dynamics;
    dynamics.set_constant(machine);
    dynamics.set_stiffness(machine, at);
    auto F = dynamics.F();
    auto&& square = square_factor(F);
    const T weak = this->solve(square, side);
    T Y[3][6];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j) Y[i][j] = side[i][j];
    orthogonalise_rows<3, 6, T>(Y, nullptr);
    const T most = max(max(row_square(Y[0]), row_square(Y[1])), row_square(Y[2]));
    return this->finish(task.lowest_stiffness_, 1.0 / most, weak, dynamics.fault);
  }

  /// Derivatives of the lowest frequency by the pose: those of omega^2 are v^T (dK - omega^2 dJ) v for its mode v.
  T gradient() const {
    using D = Dual<6, T>;
    MassAndForceMap<T, kind> dynamics;
    dynamics.set_constant(machine);
    dynamics.set(machine, at);
    const Cholesky<T> L(dynamics.J.matrix());
    Vec6<T> v;
    const T lambda = lowest_direction(dynamics.B(L), v);
    v = L.backward(v);
    v = Vec6<T>::of(at.pose.R * v.top(), at.pose.R * v.bottom());
    const Pose<D> moved = displaced(at.pose, variables<D>(0), variables<D>(3));
    const Geometry<D> g(machine.machine.design, moved, Pose<D>());
    const Mat6<D> J = inertia(machine.machine, g, moved.R);
    const auto along = [&](const auto& k) { return rayleigh_residual(k, J, spring_directions(g), v, lambda); };
    D residual = with_stiffness(machine.machine, g, along);
    if constexpr (kind == Swept::others)
      residual += other_product(other_stiffness(machine.machine, g, moved.R, Mat3<D>::identity()), v);
    const T half = 0.5 * rsqrt(lambda);
    T by[6];
    for (int i = 0; i < 6; ++i) by[i] = half * residual.d[i];
    if (task.poses.turned == 3) {
      const Vec3<T> turn(by[3], by[4], by[5]);
      by[3] = dot(turn, at.roll_axis), by[4] = dot(turn, at.pitch_axis);
    }
    const T fault = worse(!(lambda < 1e300), sweep_task::no_inertia, dynamics.fault);
    for (int i = 0; i < 6; ++i) rows.put(task.omega_1_gradient_, unless(fault > 0.0, by[i]), i, 6);
    return fault;
  }
};

}  // namespace flexapod
