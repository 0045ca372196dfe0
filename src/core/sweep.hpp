// Many poses of one machine: the quantities of a sweep for a pack of poses at a time, platform and base in the axes of
// the base (its frame is the inertial one). The mechanics is that of the single pose, over packs.
#pragma once

#include "bidiagonal.hpp"
#include "elementary.hpp"
#include "jacobi.hpp"
#include "kinematics.hpp"
#include "least_squares.hpp"
#include "modes.hpp"
#include "sweep_task.hpp"

namespace flexapod {

using sweep_task::Quantity;
using sweep_task::Task;

/// What of a machine is the same at all poses.
struct SweptMachine {
  Machine<double> machine;
  Machine<double> weightless;  // gravity enters as an acceleration of platform and base
  SpatialInertia<double> J_platform;  // platform axes
  double root_K[6];
  double size;  // of the platform: makes rows of forces and of moments comparable

  explicit SweptMachine(const Task& task)
      : machine(*reinterpret_cast<const Design<double>*>(task.design),
                task.universal ? Joint::universal : Joint::spin_free),
        weightless(machine),
        J_platform(platform_inertia(machine.design, Mat3<double>::identity())),
        size(0.0) {
    weightless.design.gravity = Vec3<double>();
    for (int i = 0; i < 6; ++i) {
      root_K[i] = __builtin_sqrt(machine.design.leg[i].stiffness);
      size += norm(machine.design.p[i]) / 6.0;
    }
  }
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
template <class T> struct Stance {
  Vec3<T> roll_axis, pitch_axis;  // where poses are given by angles
  Pose<T> pose;                   // of the platform in the base
  Geometry<T, double> g;
  T fault;

  Stance(const SweptMachine& m, const double (*rows)[T::lanes], int width)
      : pose(read(rows, width)), g(m.machine.design, base()) {
    T zero(0.0);
    for (int i = 0; i < width; ++i) zero += T::load(rows[i]) * 0.0;
    fault = worse(!(zero <= 0.0), sweep_task::not_finite, T(0.0));  // infinity and NaN times zero are NaN
    const T least(1e-24 * m.size * m.size);
    for (const Vec3<T>& S : g.S) fault = worse(!(dot(S, S) > least), sweep_task::no_leg, fault);
  }

  /// The base seen from the platform.
  Pose<T> base() const { return {-transposed(pose.R, pose.t), transpose(pose.R)}; }

 private:
  Pose<T> read(const double (*rows)[T::lanes], int width) {
    const auto row = [&](int i) { return T::load(rows[i]); };
    const Vec3<T> t(row(0), row(1), row(2));
    if (width == 12)
      return {t, {{{row(3), row(4), row(5)}, {row(6), row(7), row(8)}, {row(9), row(10), row(11)}}}};
    const SinCos<T> r(row(3)), p(row(4)), y(row(5));
    const T sr = r.sin, cr = r.cos, sp = p.sin, cp = p.cos, sy = y.sin, cy = y.cos;
    roll_axis = {cy * cp, sy * cp, -sp};
    pitch_axis = {-sy, cy, T(0.0)};
    return {t,
            {{{roll_axis.x, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
              {roll_axis.y, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
              {roll_axis.z, cp * sr, cp * cr}}}};
  }
};

/// What vibrates: J_p and H, in the platform's axes.
template <class T> struct Dynamics {
  SpatialInertia<T> J;
  Mat6<T> H;
  T fault;

  /// With lengths and directions only: J is left.
  void set_legs(const Stance<T>& at) {
    fault = at.fault;
    for (int i = 0; i < 6; ++i) {
      const Vec3<T>& S = at.g.S[i];
      set_column(i, leg_wrench(at.g.q_p[i], rsqrt(dot(S, S)) * S));
    }
  }
  void set(const SweptMachine& m, const Stance<T>& at) {
    const auto axes = [&](int i) { return LegAxes<T>(at.g.S[i], at.g.k[i], m.machine.joint); };
    const LegAxes<T> legs[6] = {axes(0), axes(1), axes(2), axes(3), axes(4), axes(5)};  // together: six long chains
    J = pack(m.J_platform);
    fault = at.fault;
    for (int i = 0; i < 6; ++i) {
      add_leg_inertia(J, legs[i], m.machine.inertia[i], at.g.q_p[i]);
      set_column(i, leg_wrench(at.g.q_p[i], legs[i].s()));
      fault = worse(!(legs[i].cosecant < 1e7), sweep_task::no_leg, fault);
    }
  }
  /// B = L^-1 H K^1/2.
  Mat6<T> B(const SweptMachine& m, const Cholesky<T>& L) const {
    Mat6<T> B;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) B[i][j] = m.root_K[j] * H[i][j];
    L.forward_all(B);
    return B;
  }

 private:
  void set_column(int i, const Vec6<T>& h) {
    for (int r = 0; r < 6; ++r) H[r][i] = h[r];
  }
  static SpatialInertia<T> pack(const SpatialInertia<double>& J) {
    const auto sym = [](const Sym3<double>& m) { return Sym3<T>{m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}; };
    return {sym(J.top), {{J.bottom_left.row[0], J.bottom_left.row[1], J.bottom_left.row[2]}}, sym(J.bottom)};
  }
};

/// Writes results of a pack of poses: rows `first` on, `count` of them.
struct Rows {
  size_t first;
  int count;

  template <class T> FLEXAPOD_INLINE void put(double* to, const T& value, int column = 0, int columns = 1) const {
    double x[T::lanes];
    value.store(x);
    for (int l = 0; l < count; ++l) to[(first + l) * columns + column] = x[l];
  }
};

/// Quantities that need no modes.
template <class T> struct SweepPart {
  const SweptMachine& machine;
  const Task& task;
  const Rows rows;
  const Stance<T>& at;

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
    if ((asked & Quantity::leg_distance) || (check && limits.leg_distance > -1e300)) {
      const T distance = least_leg_distance(at.g);
      if (asked & Quantity::leg_distance) rows.put(task.leg_distance_, unless(bad, distance));
      if (check) bound(distance, limits.leg_distance, std::numeric_limits<double>::infinity());
    }
    if (check) {
      double yes[T::lanes];
      select(within, T(1.0), T(0.0)).store(yes);
      for (int l = 0; l < rows.count; ++l) task.within_limits_[rows.first + l] = yes[l] != 0.0;
    }
  }

  /// The largest leg force at rest: weight is the same as no gravity and an acceleration of everything against it.
  T static_force() const {
    Motion<T> platform, base;
    platform.a = base.a = -transposed(at.pose.R, machine.machine.design.gravity);
    base.pose = at.base();
    const Geometry<T> g(machine.weightless.design, platform.pose, base.pose);
    Vec6<T> load[1] = {inverse_wrench(machine.weightless, g, platform, base)};
    for (int i = 3; i < 6; ++i) load[0][i] *= 1.0 / machine.size;
    const T weak = solve(load);
    T most = abs(load[0][0]);
    for (int i = 1; i < 6; ++i) most = max(most, abs(load[0][i]));
    return finish(task.leg_force_, most, weak);
  }

  /// The least translational stiffness: 1 / largest eigenvalue of the block of translations of (H K H^T)^-1, which is
  /// Y^T Y with Y = K^-1/2 H^-1 [E; 0].
  T stiffness() const {
    Vec6<T> side[3];
    for (int i = 0; i < 3; ++i) side[i][i] = T(1.0);
    const T weak = solve(side);
    T Y[3][6];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j) Y[i][j] = side[i][j] * (1.0 / machine.root_K[j]);
    orthogonalise_rows<3, 6, T>(Y, nullptr);
    const T most = max(max(row_square(Y[0]), row_square(Y[1])), row_square(Y[2]));
    return finish(task.lowest_stiffness_, 1.0 / most, weak);
  }

  /// Derivatives of the lowest frequency by the pose: those of omega^2 are v^T (dK - omega^2 dJ) v for its mode v.
  T gradient() const {
    using D = Dual<6, T>;
    Dynamics<T> dynamics;
    dynamics.set(machine, at);
    const Cholesky<T> L(dynamics.J.matrix());
    Vec6<T> v;
    const T lambda = lowest_direction(dynamics.B(machine, L), v);
    v = L.backward(v);
    v = Vec6<T>::of(at.pose.R * v.top(), at.pose.R * v.bottom());
    const Pose<D> moved = displaced(at.pose, variables<D>(0), variables<D>(3));
    const Geometry<D> g(machine.machine.design, moved, Pose<D>());
    const D residual =
        rayleigh_residual(machine.machine, inertia(machine.machine, g, moved.R), force_transformation(g), v, lambda);
    const T half = 0.5 * rsqrt(lambda);
    T by[6];
    for (int i = 0; i < 6; ++i) by[i] = half * residual.d[i];
    if (task.width == 6) {
      const Vec3<T> turn(by[3], by[4], by[5]);
      by[3] = dot(turn, at.roll_axis), by[4] = dot(turn, at.pitch_axis);
    }
    const T fault = worse(!(lambda < 1e300), sweep_task::no_inertia, dynamics.fault);
    for (int i = 0; i < 6; ++i) rows.put(task.omega_1_gradient_, unless(fault > 0.0, by[i]), i, 6);
    return fault;
  }

 private:
  static Vec3<double> direction(const double (&n)[3]) { return {n[0], n[1], n[2]}; }
  template <class U> T angle_to(const Vec3<U>& n, int i) const {
    const Vec3<T>& S = at.g.S[i];
    return upper_angle(norm(cross(n, S)), dot(n, S));
  }
  /// Solves H x = b with rows of moments divided by the platform's size; how near H is to singular.
  template <int m> T solve(Vec6<T> (&b)[m]) const {
    Dynamics<T> legs;
    legs.set_legs(at);
    for (int i = 3; i < 6; ++i)
      for (T& h : legs.H.a[i]) h *= 1.0 / machine.size;
    T weak;
    solve_orthogonal(legs.H, b, weak);
    return weak;
  }
  T finish(double* to, const T& value, const T& weak) const {
    const auto hopeless = weak < 1e-13;
    rows.put(to, unless(hopeless | (at.fault > 0.0), value));
    return worse(hopeless, sweep_task::singular, at.fault);
  }
};

/// Frequencies and the condition of H, for the joined packs of several parts.
template <class T> struct SweepModes {
  const SweptMachine& machine;
  const Task& task;
  const Rows rows;
  const Dynamics<T>& dynamics;

  template <bool all> FLEXAPOD_FLAT T frequencies() const {
    constexpr int count = all ? 6 : 1;
    Mat6<T> B = matrix();
    SquaredBidiagonal<6, T> b = bidiagonalise(B);
    const T scale = normalise(b);
    const T fault = worse(!(scale < 1e300), sweep_task::no_inertia, dynamics.fault);
    const auto bad = fault > T(sweep_task::singular);
    auto failed = bad;
    T value[6];
    if constexpr (all) all_six(b, value, failed);
    else value[0] = lowest(b, T(0.0), failed);
    failed = failed & (!bad);
    if (any(failed)) [[unlikely]] repeat(failed, scale, value);
    for (int i = 0; i < count; ++i) {
      const T omega = unless(bad, sqrt(scale * value[i]));
      if (all) rows.put(task.omega_, omega, i, 6);
      if (i == 0 && task.omega_1_ != nullptr) rows.put(task.omega_1_, omega);
    }
    return singular(value[0] < 1e-26, fault);
  }

  FLEXAPOD_FLAT T condition() const {
    Mat6<T> H = dynamics.H;
    SquaredBidiagonal<6, T> b = bidiagonalise(H);
    normalise(b);
    const auto bad = no_pose(dynamics.fault);
    auto open_low = bad, open_high = bad;
    T value[6];
    value[0] = lowest(b, T(0.0), open_low), value[5] = highest(b, open_high);
    const auto failed = (open_low | open_high) & (!bad);
    if (any(failed)) [[unlikely]] repeat_H(failed, value);
    rows.put(task.cond_H_, unless(bad, sqrt(value[5] / value[0])));
    return singular(value[0] < 1e-26 * value[5], dynamics.fault);
  }

  T status() const {
    double code[T::lanes];
    dynamics.fault.store(code);
    for (int l = 0; l < rows.count; ++l) task.status_[rows.first + l] = static_cast<std::uint8_t>(code[l]);
    return dynamics.fault;
  }

 private:
  Mat6<T> matrix() const { return dynamics.B(machine, Cholesky<T>(dynamics.J.matrix())); }

  static T singular(const mask_t<T>& bad, const T& fault) {
    return select(bad & (fault <= 0.0), T(sweep_task::singular), fault);
  }
  FLEXAPOD_COLD void repeat(const mask_t<T>& failed, const T& scale, T (&value)[6]) const {
    by_rotations(matrix(), failed, scale, value);
  }
  FLEXAPOD_COLD void repeat_H(const mask_t<T>& failed, T (&value)[6]) const {
    by_rotations(dynamics.H, failed, T(1.0), value);
  }
  static void by_rotations(const Mat6<T>& B, const mask_t<T>& failed, const T& scale, T (&value)[6]) {
    T exact[6];
    squared_singular_values(B, exact);
    for (int i = 0; i < 6; ++i) value[i] = select(failed, exact[i] / scale, value[i]);
  }
};

/// Poses of a task, in packs of T::parts parts: part by part where the work is wide and many numbers are held, joined
/// where it is one long chain. A batch of packs goes through one piece of the work after the other, so that the
/// processor keeps the piece's instructions at hand.
template <class T> class Sweep {
  using Part = typename T::Part;
  static constexpr int batch = 8;
  const Task& task;
  const SweptMachine machine;
  Dynamics<Part> part;
  Dynamics<T> joined[batch];
  double rows[12][Part::lanes];

 public:
  explicit Sweep(const Task& t) : task(t), machine(t) {}

  void run(size_t first, size_t last) {
    constexpr size_t size = size_t{batch} * T::lanes;
    for (size_t i = first; i < last; i += size) work_through(i, last - i < size ? last - i : size);
  }

 private:
  static constexpr unsigned modal = Quantity::omega_1 | Quantity::omega;
  static constexpr unsigned geometric =
      Quantity::leg_length | Quantity::joint_angle | Quantity::leg_distance | Quantity::within_limits;

  void work_through(size_t first, size_t count) {
    for (size_t done = 0; done < count; done += Part::lanes) {
      one_part(first + done, count - done < Part::lanes ? count - done : Part::lanes);
      join(joined[done / T::lanes], static_cast<int>(done / Part::lanes % T::parts));
    }
    for (size_t done = 0; done < count; done += T::lanes) {  // what is left of the last pack: its first part again
      const size_t parts = (count - done + Part::lanes - 1) / Part::lanes;
      for (size_t i = parts; i < size_t{T::parts}; ++i) join(joined[done / T::lanes], static_cast<int>(i));
    }
    const unsigned asked = task.quantities;
    const auto each = [&](auto&& piece) {
      for (size_t done = 0; done < count; done += T::lanes) {
        Dynamics<T>& dynamics = joined[done / T::lanes];
        const size_t left = count - done;
        const Rows rows{first + done, static_cast<int>(left < T::lanes ? left : T::lanes)};
        dynamics.fault = piece(SweepModes<T>{machine, task, rows, dynamics});
      }
    };
    if (asked & Quantity::cond_H) each([](const SweepModes<T>& modes) { return modes.condition(); });
    if (asked & Quantity::omega) each([](const SweepModes<T>& modes) { return modes.template frequencies<true>(); });
    else if (asked & Quantity::omega_1)
      each([](const SweepModes<T>& modes) { return modes.template frequencies<false>(); });
    each([](const SweepModes<T>& modes) { return modes.status(); });
  }

  void one_part(size_t first, size_t count) {
    load(first, count);
    const Stance<Part> at = stance();
    const unsigned asked = task.quantities;
    if (asked & modal) assemble(at);
    else if (asked & Quantity::cond_H) part.set_legs(at);
    else part.fault = at.fault;
    const SweepPart<Part> quantities{machine, task, {first, static_cast<int>(count)}, at};
    const auto note = [&](const Part& fault) { part.fault = select(part.fault > 0.0, part.fault, fault); };
    if (asked & geometric) quantities.geometry();
    if (asked & Quantity::leg_force) note(quantities.static_force());
    if (asked & Quantity::lowest_stiffness) note(quantities.stiffness());
    if (asked & Quantity::omega_1_gradient) note(quantities.gradient());
  }
  FLEXAPOD_FLAT Stance<Part> stance() const { return Stance<Part>(machine, rows, task.width); }
  FLEXAPOD_FLAT void assemble(const Stance<Part>& at) { part.set(machine, at); }

  /// A short last part is filled up with its last pose.
  void load(size_t first, size_t count) {
    for (int l = 0; l < Part::lanes; ++l) {
      const double* pose = task.poses + (first + (static_cast<size_t>(l) < count ? l : count - 1)) * task.width;
      for (int c = 0; c < task.width; ++c) rows[c][l] = pose[c];
    }
    if (task.width == 6)
      for (int c = 3; c < 6; ++c)
        if (any(abs(Part::load(rows[c])) > 1e6)) [[unlikely]] wind_down(rows[c]);
  }
  /// Angles of very many turns to within one.
  static FLEXAPOD_COLD void wind_down(double (&angles)[Part::lanes]) {
    for (double& a : angles)
      if (std::abs(a) > 1e6) a = std::atan2(std::sin(a), std::cos(a));
  }
  void join(Dynamics<T>& joined, int i) const {
    joined.fault.set_part(i, part.fault);
    if (!(task.quantities & (modal | Quantity::cond_H))) return;
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) joined.H[r][c].set_part(i, part.H[r][c]);
    if (!(task.quantities & modal)) return;
    join(joined.J.top, part.J.top, i), join(joined.J.bottom, part.J.bottom, i);
    for (int r = 0; r < 3; ++r) {
      joined.J.bottom_left.row[r].x.set_part(i, part.J.bottom_left.row[r].x);
      joined.J.bottom_left.row[r].y.set_part(i, part.J.bottom_left.row[r].y);
      joined.J.bottom_left.row[r].z.set_part(i, part.J.bottom_left.row[r].z);
    }
  }
  static void join(Sym3<T>& to, const Sym3<Part>& from, int i) {
    to.xx.set_part(i, from.xx), to.yy.set_part(i, from.yy), to.zz.set_part(i, from.zz);
    to.xy.set_part(i, from.xy), to.xz.set_part(i, from.xz), to.yz.set_part(i, from.yz);
  }
};

}  // namespace flexapod
