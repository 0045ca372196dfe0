// The exact linear dynamics about rest, with the six legs in lanes.
#pragma once

#include "model/statics.hpp"
#include "simulation/six_legs.hpp"

namespace flexapod {

/// Linear dynamics about rest: M x'' + C x' + K x + M_b x_b'' + C_b x_b' + K_b x_b = H f + w, with x, x_b the small
/// displacements (translation of the reference point, rotation vector) of platform and base in inertial axes,
/// f changes of leg force, w changes of the external wrench.
struct Tangent {
  Mat6<double> M, C, K, M_b, C_b, K_b, H;
};

/// What is asked of a machine at one pose, made once.
struct MachineAtPose {
  Machine<double> machine;
  SixLegs legs;
  bool friction;

  MachineAtPose(const Design<double>& design, Joint joint)
      : machine(design, joint), legs(machine), friction(has_friction(design)) {}
};

/// Of platform and legs at rest, in inertial axes.
class TangentAtRest {
  /// By three displacements of the platform at once: by more, numbers would be too large for compilers to keep apart, and
  /// their sums would go through memory.
  static constexpr int at_once = 3;
  using Moved = Dual<at_once, Lanes>;
  const MachineAtPose& of;
  const SixLegs& legs;
  const Pose<double>&platform, &base;
  const RestLoad& load;

 public:
  Tangent found;

  TangentAtRest(const MachineAtPose& m, const Pose<double>& p, const Pose<double>& b, const RestLoad& l)
      : of(m), legs(m.legs), platform(p), base(b), load(l) {
    const LegPlaces places(legs, platform, base);
    SpatialInertia<Lanes> J{};
    Mat6<Lanes> J_b;
    Vec6<Lanes> residual;
    for (int g = 0; g < leg_groups; ++g) {
      const LegPlaces::Group& at = places.group[g];
      const LegAxes<Lanes> leg(at.S, at.k, legs.joint);
      set_inertia(g, at, leg, J, J_b);
      add_stiffness(g, at, residual);
      if (of.friction) add_friction(g, at, leg);
    }
    finish_inertia(J, J_b);
    Vec6<double> r;
    for (int i = 0; i < 6; ++i) r[i] = sum(residual[i]);
    add_others(r);
    set_base(r);
  }

 private:
  FLEXAPOD_FLAT void set_inertia(int g, const LegPlaces::Group& at, const LegAxes<Lanes>& leg, SpatialInertia<Lanes>& J,
                                 Mat6<Lanes>& J_b) {
    add_leg_inertia(J, leg, legs.group[g].inertia, at.q_p);
    add_base_coupling(J_b, leg, legs.group[g].inertia, at.q_p, at.q_b, legs.joint);
    set_force_transformation(found.H, g, at, leg);
  }
  void finish_inertia(const SpatialInertia<Lanes>& J, const Mat6<Lanes>& J_b) {
    SpatialInertia<double> all = platform_inertia(legs.design, platform.R);
    all.top = all.top + sum(J.top), all.bottom = all.bottom + sum(J.bottom);
    for (int i = 0; i < 3; ++i) all.bottom_left.row[i] += sum(J.bottom_left.row[i]);
    found.M = all.matrix();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) found.M_b[i][j] = -sum(J_b[i][j]);
  }

  /// Weight and springs of the legs and their joints, less what holds them: its derivatives by the platform's place.
  FLEXAPOD_FLAT void add_stiffness(int g, const LegPlaces::Group& at, Vec6<Lanes>& residual) {
    const SixLegs::Group& group = legs.group[g];
    double stiffness[Lanes::lanes] = {}, length[Lanes::lanes] = {};
    for (int i = 0; i < Lanes::lanes && g * Lanes::lanes + i < 6; ++i) {
      const int which = g * Lanes::lanes + i;
      length[i] = load.L_0[which], stiffness[i] = of.machine.stiffness(which, length[i]);
    }
    Vec6<Moved> wrench;
    for (int first = 0; first < 6; first += at_once) {
      const Vec3<Moved> r = displaced(first), e = displaced(first - 3), swing = cross(e, at.q_p), q_p = at.q_p + swing;
      const LegAxes<Moved> leg(at.S + (r + swing), at.k, legs.joint);
      SphericalLoad<Moved> carried = weight_load(leg, group.inertia, leg.axes * (-legs.design.gravity));
      carried.force.x += Lanes::load(stiffness) * (leg.L - Lanes::load(length));
      if (legs.features.joints) add_springs(carried, g, leg, at, e);
      const Vec3<Moved> force = transposed(leg.axes, carried.force);
      wrench = Vec6<Moved>::of(force, cross(q_p, force) - transposed(leg.axes, carried.moment));
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < at_once; ++j) found.K[i][first + j] += sum(wrench[i].d[j]);
    }
    for (int i = 0; i < 6; ++i) residual[i] += wrench[i].v;
  }
  /// Three displacements, of which those from `first` on are the variables.
  static Vec3<Moved> displaced(int first) {
    Vec3<Moved> r;
    Moved* const component[3] = {&r.x, &r.y, &r.z};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < at_once; ++j) component[i]->d[j] = Lanes(i == first + j);
    return r;
  }
  FLEXAPOD_APART void add_springs(SphericalLoad<Moved>& carried, int g, const LegAxes<Moved>& leg,
                                  const LegPlaces::Group& at, const Vec3<Moved>& e) const {
    Mat3<Moved> R;
    const Mat3<double> columns = transpose(platform.R);
    for (int j = 0; j < 3; ++j) {
      const Vec3<Lanes> column(columns.row[j]);
      R.row[j] = column + cross(e, column);
    }
    add_joint_springs(carried, legs.joints[g].springs, legs.joints[g].rest, leg, Vec3<Moved>(at.k), transpose(R),
                      base.R, legs.joint);
  }

  /// The joints' friction by the rates, which is linear in them: by each of nine unit velocities in turn. By the velocity of
  /// the base it is that by the platform's, reversed.
  FLEXAPOD_FLAT void add_friction(int g, const LegPlaces::Group& at, const LegAxes<Lanes>& leg) {
    for (int j = 0; j < 9; ++j) {
      double unit[9] = {};
      unit[j] = 1;
      const Vec3<double> v(unit[0], unit[1], unit[2]), w(unit[3], unit[4], unit[5]), w_b(unit[6], unit[7], unit[8]);
      LegEnds<Lanes> end;
      end.v = leg.axes * (v + cross(w, at.q_p) - cross(w_b, at.q_b));
      end.omega_p = leg.axes * Vec3<Lanes>(w), end.omega_b = leg.axes * Vec3<Lanes>(w_b);
      const SphericalLoad<Lanes> lost =
          friction_load(leg, legs.group[g].leg, end, LegMotion<Lanes>(leg, end, legs.joint));
      const Vec3<Lanes> force = transposed(leg.axes, lost.force);
      const Vec6<Lanes> wrench = Vec6<Lanes>::of(force, cross(at.q_p, force) - transposed(leg.axes, lost.moment));
      for (int i = 0; i < 6; ++i) {
        const double c = sum(wrench[i]);
        if (j < 6) found.C[i][j] += c;
        if (j < 3) found.C_b[i][j] -= c;
        if (j >= 6) found.C_b[i][j - 3] += c;
      }
    }
  }
  /// The platform's weight, the external wrench and a suspension.
  FLEXAPOD_FLAT void add_others(Vec6<double>& r) {
    using D = Dual<6>;
    const Motion<D> moved = at_rest(displaceable<D>(platform, 0));
    const Vec3<D> arm = moved.pose.R * legs.design.R_0;
    const Vec3<double> weight = -(legs.design.M * legs.design.gravity);
    Vec6<D> wrench = Vec6<D>::of(Vec3<D>(weight), cross(arm, weight));
    const Vec6<D> external = external_wrench(moved.pose.R, load.wrench);
    for (int i = 0; i < 6; ++i) wrench[i] -= external[i];
    if (legs.features.suspension) {
      add_suspension_load(wrench, legs.design, moved, at_rest(constant<D>(base)));
      add_suspension_damping();
    }
    for (int i = 0; i < 6; ++i) {
      r[i] += wrench[i].v;
      for (int j = 0; j < 6; ++j) found.K[i][j] += wrench[i].d[j];
    }
  }
  FLEXAPOD_APART void add_suspension_damping() {
    using D = Dual<12>;
    Motion<D> moving = at_rest(constant<D>(platform)), moving_base = at_rest(constant<D>(base));
    moving.v = variables<D>(0), moving.w = variables<D>(3);
    moving_base.v = variables<D>(6), moving_base.w = variables<D>(9);
    const Vec6<D> lost = suspension_load(legs.design, moving, moving_base);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) found.C[i][j] += lost[i].d[j], found.C_b[i][j] += lost[i].d[6 + j];
  }

  /// K_b: where the base carries the platform with it rigidly, all turns with it but gravity. Weight and inertia go with
  /// an acceleration of everything against gravity: what a turn of gravity does is in M + M_b.
  void set_base(const Vec6<double>& r) {
    const Vec3<double> reach = platform.t - base.t, &g = legs.design.gravity;
    for (int j = 0; j < 3; ++j) {
      const Vec3<double> e(j == 0, j == 1, j == 2), carried = cross(e, reach), turned = cross(e, g);
      const Vec6<double> whole = Vec6<double>::of(cross(e, r.top()), cross(e, r.bottom()));
      const double x[] = {carried.x, carried.y, carried.z}, a[] = {turned.x, turned.y, turned.z};
      for (int i = 0; i < 6; ++i) {
        found.K_b[i][j] = -found.K[i][j];
        found.K_b[i][3 + j] = whole[i] - found.K[i][3 + j];
        for (int k = 0; k < 3; ++k)
          found.K_b[i][3 + j] += (found.M[i][k] + found.M_b[i][k]) * a[k] - found.K[i][k] * x[k];
      }
    }
  }
};

}  // namespace flexapod
