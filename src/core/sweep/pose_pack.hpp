// How a machine stands in a pack of poses: platform and base in the axes of the platform, where the platform's joints
// and inertia are constants. The base's frame is the inertial one.
#pragma once

#include "model/leg_distance.hpp"
#include "model/springs.hpp"
#include "simd/elementary.hpp"
#include "sweep/task.hpp"

namespace flexapod {

/// What of a machine is the same at all poses.
struct SweptMachine {
  Machine<double> machine;
  Machine<double> weightless;            // gravity enters as an acceleration of platform and base
  SpatialInertia<double> J_platform;     // platform axes
  RootStiffness<double> root_stiffness;  // where it is the same at all poses
  SharedJoints shared;
  double size;  // of the platform: makes rows of forces and of moments comparable

  explicit SweptMachine(const sweep_task::Task& task)
      : machine(*reinterpret_cast<const Design<double>*>(task.design), task.joint),
        weightless(machine),
        J_platform(platform_inertia(machine.design, Mat3<double>::identity())),
        root_stiffness(machine.axial.constant),
        shared(machine.design),
        size(mean_radius(machine.design)) {
    weightless.design.gravity = Vec3<double>();
  }

  /// Whether springs along the legs are the same at all poses.
  bool constant() const { return machine.features.law == Law::constant; }
};

/// A fault is a status as a number in a lane. What is wrong with the pose itself is not replaced.
template <class T> FLEXAPOD_INLINE T worse(const mask_t<T>& bad, sweep_task::Status status, const T& fault) {
  return select(bad & (fault <= T(sweep_task::singular)), T(status), fault);
}
/// Lanes where legs have no directions.
template <class T> FLEXAPOD_INLINE mask_t<T> no_pose(const T& fault) {
  return (fault >= T(sweep_task::no_leg)) & (fault <= T(sweep_task::not_finite));
}

/// The value, or NaN in lanes where it has no meaning.
template <class T> FLEXAPOD_INLINE T unless(const mask_t<T>& bad, const T& value) {
  return select(bad, T(std::numeric_limits<double>::quiet_NaN()), value);
}

/// A pack of poses and how the machine stands there, in the platform's axes.
template <class T> struct PosePack {
  Vec3<T> roll_axis, pitch_axis;  // where poses are given by angles
  Pose<T> pose;                   // of the platform in the base
  Geometry<T, double> g;
  T fault;

  /// turned: numbers of a rotation, as `sweep_task::Poses` has them.
  PosePack(const SweptMachine& m, const double (*rows)[T::lanes], int turned)
      : pose(read(rows, turned)), g(m.machine.design, base()) {
    T zero(0.0);
    for (int i = 0; i < 3 + turned; ++i) zero += T::load(rows[i]) * 0.0;
    fault = worse(!(zero <= 0.0), sweep_task::not_finite, T(0.0));  // infinity and NaN times zero are NaN
    const T least(1e-24 * m.size * m.size);
    for (const Vec3<T>& S : g.S) fault = worse(!(dot(S, S) > least), sweep_task::no_leg, fault);
  }

  /// The base seen from the platform.
  Pose<T> base() const { return {-transposed(pose.R, pose.t), transpose(pose.R)}; }

 private:
  Pose<T> read(const double (*rows)[T::lanes], int turned) {
    const auto row = [&](int i) { return T::load(rows[i]); };
    const Vec3<T> t(row(0), row(1), row(2));
    if (turned == 4) return {t, quaternion_rotation(row(6), {row(3), row(4), row(5)})};
    if (turned == 9) return {t, {{{row(3), row(4), row(5)}, {row(6), row(7), row(8)}, {row(9), row(10), row(11)}}}};
    const SinCos<T> r(row(3)), p(row(4)), y(row(5));
    const Mat3<T> R = roll_pitch_yaw<T>({r.sin, p.sin, y.sin}, {r.cos, p.cos, y.cos});
    roll_axis = {R.row[0].x, R.row[1].x, R.row[2].x};
    pitch_axis = {-y.sin, y.cos, T(0.0)};
    return {t, R};
  }
};
template <class T>
FLEXAPOD_FLAT PosePack<T> pose_pack(const SweptMachine& m, const double (*rows)[T::lanes], int turned) {
  return PosePack<T>(m, rows, turned);
}

/// Which springs a sweep's machine has: along the legs only, or others too. Each is a kernel of its own.
enum class Swept { along_legs, others };

/// sum k d d^T of joints and suspension, platform axes.
template <class T, Swept kind> struct OtherSprings {};
template <class T> struct OtherSprings<T, Swept::others> {
  SpatialInertia<T> sum;
};

/// The directions of the springs along the legs, in the platform's axes: H.
template <class T> struct ForceMap {
  SpringMatrix<T> directions;
  T fault;

  /// With lengths and directions only.
  void set_legs(const PosePack<T>& at) {
    fault = at.fault;
    for (int i = 0; i < 6; ++i) set_spring_directions(directions, i, at.g);
  }
};

/// What vibrates: J_p and the springs, in the platform's axes.
template <class T, Swept kind> struct MassAndForceMap : ForceMap<T> {
  SpatialInertia<T> J;
  RootStiffness<T> along;
  OtherSprings<T, kind> others;
  using ForceMap<T>::directions, ForceMap<T>::fault;

  /// Springs along the legs that are the same at all poses.
  void set_constant(const SweptMachine& m) {
    for (int j = 0; j < spring_count; ++j) along.root[j] = T(m.root_stiffness.root[j]);
  }
  /// With springs of all kinds as well; J is left.
  void set_stiffness(const SweptMachine& m, const PosePack<T>& at) {
    if (kind == Swept::along_legs && m.constant()) {
      this->set_legs(at);
    } else {
      const auto axes = [&](int i) { return LegAxes<T>(at.g.S[i], at.g.k[i], m.machine.joint); };
      const LegAxes<T> legs[6] = {axes(0), axes(1), axes(2), axes(3), axes(4), axes(5)};
      fault = at.fault;
      for (int i = 0; i < 6; ++i) set_spring_directions(directions, i, at.g.q_p[i], legs[i]);
      set_springs(m, at, legs);
    }
  }
  void set(const SweptMachine& m, const PosePack<T>& at) {
    const auto axes = [&](int i) { return LegAxes<T>(at.g.S[i], at.g.k[i], m.machine.joint); };
    const LegAxes<T> legs[6] = {axes(0), axes(1), axes(2), axes(3), axes(4), axes(5)};  // together: six long chains
    SpatialInertia<T> sum = pack(m.J_platform);  // kept apart from what is written meanwhile
    T bad = at.fault;
    for (int i = 0; i < 6; ++i) {
      add_leg_inertia(sum, legs[i], m.machine.inertia[i], at.g.q_p[i]);
      set_spring_directions(directions, i, at.g.q_p[i], legs[i]);
      bad = worse(!(legs[i].cosecant < 1e7), sweep_task::no_leg, bad);
    }
    J = sum, fault = bad;
    set_springs(m, at, legs);
  }
  /// What of the springs goes with the pose.
  void set_springs(const SweptMachine& m, const PosePack<T>& at, const LegAxes<T> (&legs)[6]) {
    if (!m.constant()) {
      for (int i = 0; i < 6; ++i) {
        const T k = m.machine.axial.at(m.machine.design, m.machine.features, i, legs[i].L);
        along.root[i] = sqrt(k);
        fault = worse(!(k > 0.0), sweep_task::outside_stiffness_law, fault);
      }
    }
    if constexpr (kind == Swept::others) {
      others.sum = SpatialInertia<T>{zero(), {{none(), none(), none()}}, zero()};
      if (m.machine.features.joints)
        for (int i = 0; i < 6; ++i)
          add_joint_stiffness(others.sum, legs[i], m.machine.design.springs[i], at.g.q_p[i], m.machine.joint);
      if (m.machine.features.suspension) add_suspension(others.sum, m.machine.design, Mat3<T>::identity(), at.base().R);
    }
  }
  /// F: six columns, or those along the legs and a square root of all others.
  auto F() const {
    if constexpr (kind == Swept::along_legs) return along.scaled(directions);
    else return Blocks<T>{along.scaled(directions), semidefinite_root(others.sum.matrix())};
  }
  /// B = L^-1 F.
  auto B(const Cholesky<T>& L) const {
    auto B = F();
    if constexpr (kind == Swept::others) L.forward_all(B.A), L.forward_lower(B.C);
    else L.forward_all(B);
    return B;
  }

 private:
  static Sym3<T> zero() { return {T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)}; }
  static Vec3<T> none() { return {T(0.0), T(0.0), T(0.0)}; }
  static SpatialInertia<T> pack(const SpatialInertia<double>& J) {
    const auto sym = [](const Sym3<double>& m) { return Sym3<T>{m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}; };
    return {sym(J.top), {{J.bottom_left.row[0], J.bottom_left.row[1], J.bottom_left.row[2]}}, sym(J.bottom)};
  }
};

/// L^-1 F with a column for each spring, where a square root of their sum would not be accurate enough.
template <class T>
FLEXAPOD_COLD Mat6<T, all_springs> all_columns(const SweptMachine& m, const PosePack<T>& at, const SpatialInertia<T>& J,
                                               const RootStiffness<T>& along) {
  Mat6<T, all_springs> B;
  const Mat6<double> C = suspension_root(m.machine.design);
  const Mat3<T> R_b = at.base().R;
  for (int i = 0; i < 6; ++i) {
    const LegAxes<T> leg(at.g.S[i], at.g.k[i], m.machine.joint);
    const Vec6<T> h = leg_wrench(at.g.q_p[i], leg.s());
    const JointDirections<T> joint(leg, at.g.q_p[i], m.machine.joint);
    Vec6<T> column;
    for (int r = 0; r < 6; ++r) column[r] = T(C[r][i]);
    column = suspension_wrench_at(R_b, Vec3<T>(m.machine.design.suspension_point), column);
    for (int r = 0; r < 6; ++r) {
      B[r][i] = along.root[i] * h[r], B[r][spring_count + joint_spring_count + i] = column[r];
      for (int j = 0; j < springs_of_joints; ++j)
        B[r][spring_count + springs_of_joints * i + j] =
            std::sqrt(joint_stiffness(m.machine.design.springs[i], j)) * joint.d[j][r];
    }
  }
  Cholesky<T>(J.matrix()).forward_all(B);
  return B;
}

/// Writes results of a pack of poses: rows `first` on, `count` of them.
struct Rows {
  size_t first;
  int count;

  template <class T> FLEXAPOD_INLINE void put(double* to, const T& value, int column = 0, int columns = 1) const {
    if (columns == 1 && count == T::lanes) return value.store(to + first);
    double x[T::lanes];
    value.store(x);
    for (int l = 0; l < count; ++l) to[(first + l) * columns + column] = x[l];
  }
};

}  // namespace flexapod
