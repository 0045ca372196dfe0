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
  Mat6<double> J_platform;     // platform axes
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

/// A pack of poses and how the machine stands there, in the platform's axes.
template <class T> struct Stance {
  using M = mask_t<T>;

  Pose<T> pose;                // of the platform in the base
  Vec3<T> roll_axis, pitch_axis;  // where poses are given by angles
  Geometry<T, double> g;
  M finite, legs;  // lanes with a pose, and with legs

  Stance(const SweptMachine& m, const double (*rows)[T::lanes], int width)
      : pose(read(rows, width)), g(m.machine.design, Pose<T>{-transposed(pose.R, pose.t), transpose(pose.R)}) {
    T sum(0.0);
    for (int i = 0; i < width; ++i) sum += T::load(rows[i]) * 0.0;
    finite = sum <= 0.0;  // infinity and NaN times zero are NaN
    legs = finite;
    const T least(1e-24 * m.size * m.size);
    for (const Vec3<T>& S : g.S) legs = legs & (dot(S, S) > least);
  }

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

/// H, J_p = L L^T and B = L^-1 H K^1/2, in the platform's axes.
template <class T> struct Dynamics {
  Mat6<T> H;
  mask_t<T> legs;  // lanes where no leg lies along its universal axis
  Cholesky<T> L;

  Dynamics(const SweptMachine& m, const Stance<T>& at) : L(assemble(m, at)) {}

  Mat6<T> B(const SweptMachine& m) const {
    Mat6<T> B;
    for (int j = 0; j < 6; ++j) {
      Vec6<T> h;
      for (int i = 0; i < 6; ++i) h[i] = m.root_K[j] * H[i][j];
      h = L.forward(h);
      for (int i = 0; i < 6; ++i) B[i][j] = h[i];
    }
    return B;
  }

 private:
  Mat6<T> assemble(const SweptMachine& m, const Stance<T>& at) {
    Mat6<T> J;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) J[i][j] = T(m.J_platform[i][j]);
    legs = at.legs;
    for (int i = 0; i < 6; ++i) {
      const LegAxes<T> leg(at.g.S[i], at.g.k[i], m.machine.joint);
      add_inertia_at(J, at.g.q_p[i], rotate(transpose(leg.axes), leg_inertia(leg, m.machine.inertia[i])));
      const Vec6<T> h = leg_wrench(at.g.q_p[i], leg.s());
      for (int r = 0; r < 6; ++r) H[r][i] = h[r];
      legs = legs & (leg.cosecant < 1e7);
    }
    return J;
  }
};

template <class T> Mat6<T> force_transformation(const Stance<T>& at) {
  Mat6<T> H;
  for (int i = 0; i < 6; ++i) {
    const Vec6<T> h = leg_wrench(at.g.q_p[i], rsqrt(dot(at.g.S[i], at.g.S[i])) * at.g.S[i]);
    for (int r = 0; r < 6; ++r) H[r][i] = h[r];
  }
  return H;
}

/// A pack of a task: computes what is asked for and writes it to the task's arrays.
template <class T> class SweepPack {
  using M = mask_t<T>;
  const SweptMachine& machine;
  const Task& task;
  const size_t first;
  const int count;  // lanes that are poses of the task; the rest repeat the last
  const Stance<T> at;
  M singular, no_leg, no_inertia;

 public:
  SweepPack(const SweptMachine& m, const Task& t, const double (*rows)[T::lanes], size_t first_, int count_)
      : machine(m), task(t), first(first_), count(count_), at(m, rows, t.width) {
    singular = no_inertia = T(1.0) < T(0.0);
    no_leg = !at.legs;
    const unsigned asked = task.quantities;
    if (asked & (Quantity::omega_1 | Quantity::omega | Quantity::omega_1_gradient)) {
      const Dynamics<T> dynamics(m, at);
      no_leg = no_leg | (!dynamics.legs);
      if (asked & (Quantity::omega_1 | Quantity::omega)) frequencies(dynamics);
      if (asked & Quantity::omega_1_gradient) gradient(dynamics);
      if (asked & Quantity::cond_H) condition(dynamics.H);
    } else if (asked & Quantity::cond_H) {
      condition(force_transformation(at));
    }
    if (asked & (Quantity::leg_length | Quantity::joint_angle | Quantity::leg_distance | Quantity::within_limits))
      geometry();
    if (asked & Quantity::leg_force) static_force();
    if (asked & Quantity::lowest_stiffness) stiffness();
    write_status();
  }

 private:
  void put(double* to, const T& value, int column = 0, int columns = 1) const {
    double x[T::lanes];
    value.store(x);
    for (int l = 0; l < count; ++l) to[(first + l) * columns + column] = x[l];
  }
  /// The value, or NaN in lanes where it has no meaning.
  static T unless(const M& bad, const T& value) {
    return select(bad, T(std::numeric_limits<double>::quiet_NaN()), value);
  }

  void frequencies(const Dynamics<T>& dynamics) {
    Mat6<T> B = dynamics.B(machine);
    SquaredBidiagonal<6, T> b = bidiagonalise(B);
    const T scale = normalise(b);
    const M bad = no_leg | (!(scale < 1e300));
    no_inertia = no_inertia | bad;
    M failed;
    T value[6];
    const bool all = task.quantities & Quantity::omega;
    if (all) all_six(b, value, failed);
    else value[0] = lowest(b, T(0.0), failed);
    failed = failed & (!bad);
    if (any(failed)) [[unlikely]] {
      T exact[6];
      squared_singular_values(dynamics.B(machine), exact);
      for (int i = 0; i < (all ? 6 : 1); ++i) value[i] = select(failed, exact[i] / scale, value[i]);
    }
    singular = singular | (value[0] < 1e-26);
    for (int i = 0; i < (all ? 6 : 1); ++i) {
      const T omega = unless(bad, sqrt(scale * value[i]));
      if (all) put(task.omega_, omega, i, 6);
      if (i == 0 && task.omega_1_ != nullptr) put(task.omega_1_, omega);
    }
  }

  void condition(Mat6<T> H) {
    const Mat6<T> kept = H;
    SquaredBidiagonal<6, T> b = bidiagonalise(H);
    normalise(b);
    M open_low, open_high;
    T low = lowest(b, T(0.0), open_low), high = highest(b, open_high);
    const M failed = (open_low | open_high) & at.legs;
    if (any(failed)) [[unlikely]] {
      T exact[6];
      squared_singular_values(kept, exact);
      low = select(failed, exact[0], low), high = select(failed, exact[5], high);
    }
    singular = singular | (low < 1e-26 * high);
    put(task.cond_H_, unless(!at.legs, sqrt(high / low)));
  }

  /// Derivatives of the lowest frequency by the pose: those of omega^2 are v^T (dK - omega^2 dJ) v for its mode v.
  void gradient(const Dynamics<T>& dynamics) {
    using D = Dual<6, T>;
    Vec6<T> v;
    const T lambda = lowest_direction(dynamics.B(machine), v);
    v = dynamics.L.backward(v);
    v = Vec6<T>::of(at.pose.R * v.top(), at.pose.R * v.bottom());
    const auto variables3 = [](int i) {
      const T zero(0.0);
      return Vec3<D>(D::variable(zero, i), D::variable(zero, i + 1), D::variable(zero, i + 2));
    };
    const Pose<D> moved = displaced(at.pose, variables3(0), variables3(3));
    const Geometry<D> g(machine.machine.design, moved, Pose<D>());
    const D residual = rayleigh_residual(machine.machine, inertia(machine.machine, g, moved.R), force_transformation(g), v, lambda);
    const T half = 0.5 * rsqrt(lambda);
    T by[6];
    for (int i = 0; i < 6; ++i) by[i] = half * residual.d[i];
    if (task.width == 6) {
      const Vec3<T> turn(by[3], by[4], by[5]);
      by[3] = dot(turn, at.roll_axis), by[4] = dot(turn, at.pitch_axis);
    }
    const M bad = no_leg | (!(lambda < 1e300));
    no_inertia = no_inertia | bad;
    for (int i = 0; i < 6; ++i) put(task.omega_1_gradient_, unless(bad, by[i]), i, 6);
  }

  void geometry() {
    const unsigned asked = task.quantities;
    const sweep_task::Limits& limits = *task.limits;
    const bool check = asked & Quantity::within_limits;
    M within = at.legs;
    const auto bound = [&](const T& value, double low, double high) {
      within = within & (value >= low) & (value <= high);
    };
    const bool lengths = asked & Quantity::leg_length;
    const bool angles = asked & Quantity::joint_angle;
    const bool limited = limits.universal_angle < 1e300 || limits.spherical_angle < 1e300;
    const auto direction = [](const double (&n)[3]) { return Vec3<double>(n[0], n[1], n[2]); };
    for (int i = 0; i < 6; ++i) {
      const Vec3<T>& S = at.g.S[i];
      if (lengths || check) {
        const T L = norm(S);
        if (lengths) put(task.leg_length_, unless(no_leg_at_all(), L), i, 6);
        if (check) bound(L, limits.length[i][0], limits.length[i][1]);
      }
      if (angles || (check && limited)) {
        const Vec3<T> n_b = transposed(at.pose.R, direction(limits.neutral[0][i]));
        const Vec3<double> n_p = direction(limits.neutral[1][i]);
        const T universal = upper_angle(norm(cross(n_b, S)), dot(n_b, S));
        const T spherical = upper_angle(norm(cross(n_p, S)), dot(n_p, S));
        if (angles) put(task.universal_angle_, unless(no_leg_at_all(), universal), i, 6);
        if (angles) put(task.spherical_angle_, unless(no_leg_at_all(), spherical), i, 6);
        if (check) bound(universal, -1.0, limits.universal_angle), bound(spherical, -1.0, limits.spherical_angle);
      }
    }
    if ((asked & Quantity::leg_distance) || (check && limits.leg_distance > -1e300)) {
      const T distance = least_leg_distance(at.g);
      if (asked & Quantity::leg_distance) put(task.leg_distance_, unless(no_leg_at_all(), distance));
      if (check) bound(distance, limits.leg_distance, std::numeric_limits<double>::infinity());
    }
    if (check) {
      double yes[T::lanes];
      select(within, T(1.0), T(0.0)).store(yes);
      for (int l = 0; l < count; ++l) task.within_limits_[first + l] = yes[l] != 0.0;
    }
  }
  M no_leg_at_all() const { return !at.legs; }

  /// H with its rows of moments divided by the platform's size.
  Mat6<T> scaled_H() const {
    Mat6<T> H = force_transformation(at);
    for (int i = 3; i < 6; ++i)
      for (T& h : H.a[i]) h *= 1.0 / machine.size;
    return H;
  }

  /// The largest leg force at rest: gravity g is the same as no gravity and an acceleration -g of everything.
  void static_force() {
    Motion<T> platform, base;
    platform.a = base.a = -transposed(at.pose.R, machine.machine.design.gravity);
    base.pose = {-transposed(at.pose.R, at.pose.t), transpose(at.pose.R)};
    const Geometry<T> g(machine.weightless.design, platform.pose, base.pose);
    Vec6<T> load[1] = {inverse_wrench(machine.weightless, g, platform, base)};
    for (int i = 3; i < 6; ++i) load[0][i] *= 1.0 / machine.size;
    Mat6<T> H = scaled_H();
    T weak;
    solve_orthogonal(H, load, weak);
    T most = abs(load[0][0]);
    for (int i = 1; i < 6; ++i) most = max(most, abs(load[0][i]));
    const M hopeless = weak < 1e-13;
    singular = singular | hopeless;
    put(task.leg_force_, unless((!at.legs) | hopeless, most));
  }

  /// The least translational stiffness: 1 / largest eigenvalue of the block of translations of (H K H^T)^-1, which is
  /// Y^T Y with Y = K^-1/2 H^-1 [E; 0].
  void stiffness() {
    Vec6<T> side[3];
    for (int i = 0; i < 3; ++i) side[i][i] = T(1.0);
    Mat6<T> H = scaled_H();
    T weak;
    solve_orthogonal(H, side, weak);
    T rows[3][6];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j) rows[i][j] = side[i][j] * (1.0 / machine.root_K[j]);
    orthogonalise_rows<3, 6, T>(rows, nullptr);
    const T most = max(max(row_square(rows[0]), row_square(rows[1])), row_square(rows[2]));
    const M hopeless = weak < 1e-13;
    singular = singular | hopeless;
    put(task.lowest_stiffness_, unless((!at.legs) | hopeless, 1.0 / most));
  }

  void write_status() const {
    T code = select(singular, T(sweep_task::singular), T(sweep_task::ok));
    code = select(no_inertia, T(sweep_task::no_inertia), code);
    code = select(no_leg, T(sweep_task::no_leg), code);
    code = select(at.finite, code, T(sweep_task::not_finite));
    double x[T::lanes];
    code.store(x);
    for (int l = 0; l < count; ++l) task.status_[first + l] = static_cast<std::uint8_t>(x[l]);
  }
};

/// Poses first to last of a task.
template <class T> void sweep(const Task& task, size_t first, size_t last) {
  const SweptMachine machine(task);
  double rows[12][T::lanes];
  for (size_t i = first; i < last; i += T::lanes) {
    const int count = last - i < size_t{T::lanes} ? static_cast<int>(last - i) : T::lanes;
    for (int l = 0; l < T::lanes; ++l) {
      const double* pose = task.poses + (i + (l < count ? l : count - 1)) * task.width;
      for (int c = 0; c < task.width; ++c) rows[c][l] = pose[c];
    }
    SweepPack<T>(machine, task, rows, i, count);
  }
}

}  // namespace flexapod
