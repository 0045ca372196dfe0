// The exact linear dynamics about rest, with the six legs in lanes.
#pragma once

#include "model/statics.hpp"
#include "one_pose/task.hpp"
#include "simulation/six_legs.hpp"

namespace flexapod {

/// What is asked of a machine at one pose, made once.
struct MachineAtPose {
  Machine<double> machine;
  SixLegs legs;
  bool friction;

  MachineAtPose(const Design<double>& design, Joint joint)
      : machine(design, joint), legs(machine), friction(has_friction(design)) {}
};

/// A group of legs at rest: where they are, and what their platform joints carry beside the springs along the legs;
/// inertial axes.
struct LegsAtRest {
  const GroupPlaces at;
  const LegAxes<Lanes> leg;
  const Vec3<Lanes> a;  // against gravity, leg axes
  Vec3<Lanes> force, moment;

  FLEXAPOD_FLAT LegsAtRest(const SixLegs& legs, int g, const Pose<double>& platform, const Pose<double>& base)
      : at(legs.group[g].places(platform, base)),
        leg(at.S, at.k, legs.joint),
        a(leg.axes * -legs.design.gravity),
        force(transposed(leg.axes, weight_load(leg, legs.group[g].inertia, a).force)) {}
  Vec6<Lanes> wrench() const { return Vec6<Lanes>::of(force, cross(at.q_p, force) - moment); }
};

/// The linear dynamics about rest: M x'' + C x' + K x + M_b x_b'' + C_b x_b' + K_b x_b = H f + w, with x, x_b the small
/// displacements (translation of the reference point, rotation vector) of platform and base in inertial axes,
/// f changes of leg force, w changes of the external wrench. M, C and H come with it; then the forces that hold the legs,
/// which K goes with, and what is asked of the base. Matrices are set in their place: as members they would be zeroed and
/// copied, which takes a good part of the time.
class TangentAtRest {
  using Groups = std::make_integer_sequence<int, leg_groups>;
  using Moved = Dual<3, Lanes>;  // more than three variables GCC does not keep apart: it sums them in memory
  const MachineAtPose& of;
  const SixLegs& legs;
  const Pose<double>&platform, &base;
  const Vec3<double> mass_center, weight;
  const Vec6<double> external;
  LegsAtRest group[leg_groups];
  Mat6<double>&M, &C, &K, &H;

 public:
  TangentAtRest(const MachineAtPose& m, const Pose<double>& p, const Pose<double>& b, const Vec6<double>& wrench,
                const one_pose_task::Matrices& to)
      : TangentAtRest(m, p, b, wrench, to, Groups()) {
    for (int g = 0; g < leg_groups; ++g) {
      set_force_transformation(H, g, group[g].at, group[g].leg);
      if (legs.features.joints) add_joint_loads(g);
    }
    set_inertia();
    set_friction();
    if (legs.features.suspension) add_suspension_damping(C, false);
  }

  /// The leg forces that hold the platform; NaN where H is singular.
  Vec6<double> leg_forces() const {
    Vec6<double> load = Vec6<double>::of(weight, cross(mass_center, weight)), held;
    Vec6<Lanes> of_legs = group[0].wrench();
    for (int g = 1; g < leg_groups; ++g) {
      const Vec6<Lanes> wrench = group[g].wrench();
      add(of_legs, wrench.top(), wrench.bottom());
    }
    for (int i = 0; i < 6; ++i) load[i] += sum(of_legs[i]) - external[i];
    if (legs.features.suspension) add_suspension_load(load, legs.design, at_rest(platform), at_rest(base));
    if (!solve_general(H, load, held)) held = Vec6<double>{{NAN, NAN, NAN, NAN, NAN, NAN}};
    return held;
  }
  Vec6<double> leg_lengths() const {
    PerLeg length;
    for (int g = 0; g < leg_groups; ++g) length.group[g] = group[g].leg.L;
    return length.six();
  }
  /// For leg forces and the stiffnesses along the legs that go with them.
  void set_stiffness(const Vec6<double>& force, const Vec6<double>& stiffness) {
    set_leg_stiffness(PerLeg(force), PerLeg(stiffness), Groups());
    for (int j = 0; j < 3; ++j) {
      const Vec3<double> e = axis(j), moment = cross(cross(e, mass_center), weight) - cross(e, external.bottom());
      const Vec6<double> turned = Vec6<double>::of(-cross(e, external.top()), moment);
      for (int i = 0; i < 6; ++i) K[i][3 + j] += turned[i];
    }
    if (legs.features.joints)
      for (int g = 0; g < leg_groups; ++g) add_joint_stiffness(g);
    if (legs.features.suspension) add_suspension_stiffness();
  }
  /// After K. Where the base carries the platform with it rigidly, all turns with it but gravity. Weight and inertia go
  /// with an acceleration of everything against gravity: what a turn of gravity does is in M + M_b.
  void set_base(const one_pose_task::Matrices& to) {
    Mat6<double>&M_b = matrix(to.M_b), &C_b = matrix(to.C_b), &K_b = matrix(to.K_b);
    set_base_inertia(M_b);
    set_base_damping(C_b);
    const Vec3<double> reach = platform.t - base.t;
    for (int j = 0; j < 3; ++j) {
      const Vec3<double> carried = cross(axis(j), reach), turned = cross(axis(j), legs.design.gravity);
      const double x[] = {carried.x, carried.y, carried.z}, a[] = {turned.x, turned.y, turned.z};
      for (int i = 0; i < 6; ++i) {
        K_b[i][j] = -K[i][j], K_b[i][3 + j] = -K[i][3 + j];
        for (int k = 0; k < 3; ++k) K_b[i][3 + j] += (M[i][k] + M_b[i][k]) * a[k] - K[i][k] * x[k];
      }
    }
  }

 private:
  template <int... g>
  TangentAtRest(const MachineAtPose& m, const Pose<double>& p, const Pose<double>& b, const Vec6<double>& wrench,
                const one_pose_task::Matrices& to, std::integer_sequence<int, g...>)
      : of(m),
        legs(m.legs),
        platform(p),
        base(b),
        mass_center(p.R * legs.design.R_0),
        weight(-(legs.design.M * legs.design.gravity)),
        external(external_wrench(p.R, wrench)),
        group{LegsAtRest(legs, g, p, b)...},
        M(matrix(to.M)),
        C(matrix(to.C)),
        K(matrix(to.K)),
        H(matrix(to.H)) {}
  static Mat6<double>& matrix(double* numbers) { return *reinterpret_cast<Mat6<double>*>(numbers); }
  static Vec3<double> axis(int j) { return {double(j == 0), double(j == 1), double(j == 2)}; }

  FLEXAPOD_FLAT void set_inertia() {
    SpatialInertia<Lanes> J{};
    for (int g = 0; g < leg_groups; ++g) add_leg_inertia(J, group[g].leg, legs.group[g].inertia, group[g].at.q_p);
    M = inertia(legs.design, platform.R, J);
  }

  /// The force of legs changes with the place of the platform's joint, which a turn of the platform moves.
  template <int... g>
  FLEXAPOD_FLAT void set_leg_stiffness(const PerLeg& push, const PerLeg& stiffness, std::integer_sequence<int, g...>) {
    const Mat3<Lanes> by_place[]{force_by_place(g, push.group[g], stiffness.group[g])...};
    const Vec3<Lanes> force[]{(group[g].force - push.group[g] * group[g].leg.s())...};
    for (int j = 0; j < 3; ++j) {
      Vec6<Lanes> moved, turned;
      for (int k = 0; k < leg_groups; ++k) {
        const Vec3<Lanes>&q = group[k].at.q_p, swing = cross(Vec3<Lanes>(axis(j)), q);
        const Vec3<Lanes>&by_move = by_place[k].row[j], by_turn = transposed(by_place[k], swing);
        add(moved, by_move, cross(q, by_move));
        add(turned, by_turn, cross(q, by_turn) + cross(swing, force[k]));
      }
      for (int i = 0; i < 6; ++i) K[i][j] = sum(moved[i]), K[i][3 + j] = sum(turned[i]);
    }
  }
  /// Derivatives of the force at the platform joint, as rows.
  Mat3<Lanes> force_by_place(int g, const Lanes& push, const Lanes& stiffness) const {
    const LegAxes<Lanes>& leg = group[g].leg;
    const Lanes cotangent = dot(group[g].at.k, leg.s()) * leg.cosecant, across = leg.u * push;
    Mat3<Lanes> by = weight_stiffness(leg, legs.group[g].inertia, group[g].a, cotangent, legs.joint);
    by.row[0].x += stiffness, by.row[1].y -= across, by.row[2].z -= across;
    return transpose(leg.axes) * (by * leg.axes);
  }

  /// What springs in joints carry, where the legs' platform joints are moved by r and the platform is turned by e;
  /// inertial axes.
  template <class T> SphericalLoad<T> joint_springs(int g, const Vec3<T>& r, const Vec3<T>& e) const {
    const GroupPlaces& at = group[g].at;
    const LegAxes<T> leg(at.S + r, at.k, legs.joint);
    const Mat3<double> columns = transpose(platform.R);
    Mat3<T> R;
    for (int j = 0; j < 3; ++j) {
      const Vec3<Lanes> column(columns.row[j]);
      R.row[j] = column + cross(e, column);
    }
    SphericalLoad<T> load{};
    add_joint_springs(load, legs.joints[g].springs, legs.joints[g].rest, leg, Vec3<T>(at.k), transpose(R), base.R,
                      legs.joint);
    return {transposed(leg.axes, load.force), transposed(leg.axes, load.moment)};
  }
  FLEXAPOD_APART void add_joint_loads(int g) {
    const SphericalLoad<Lanes> load = joint_springs(g, Vec3<Lanes>(), Vec3<Lanes>());
    group[g].force += load.force, group[g].moment = load.moment;
  }
  FLEXAPOD_APART void add_joint_stiffness(int g) {
    const Vec3<Lanes>& q = group[g].at.q_p;
    const Vec3<Moved> none, moved = variables<Moved>(0);
    const SphericalLoad<Moved> by_place = joint_springs(g, moved, none), by_turn = joint_springs(g, none, moved);
    const auto part = [](const Vec3<Moved>& v, int j) { return Vec3<Lanes>(v.x.d[j], v.y.d[j], v.z.d[j]); };
    const auto swung = [&](const Vec3<Moved>& v, const Vec3<Lanes>& by) {
      return by.x * part(v, 0) + by.y * part(v, 1) + by.z * part(v, 2);
    };
    for (int j = 0; j < 3; ++j) {
      const Vec3<Lanes> swing = cross(Vec3<Lanes>(axis(j)), q), force = part(by_place.force, j);
      const Vec3<Lanes> turned = swung(by_place.force, swing) + part(by_turn.force, j);
      const Vec3<Lanes> moment = swung(by_place.moment, swing) + part(by_turn.moment, j);
      const Vec6<Lanes> column = Vec6<Lanes>::of(force, cross(q, force) - part(by_place.moment, j));
      const Vec6<Lanes> turned_column = Vec6<Lanes>::of(turned, cross(q, turned) - moment);
      for (int i = 0; i < 6; ++i) K[i][j] += sum(column[i]), K[i][3 + j] += sum(turned_column[i]);
    }
  }

  /// The friction of a group's joints by their rates, in which it is linear; leg axes.
  SphericalLoad<Lanes> friction_by(int g, const LegEnds<Lanes>& rates) const {
    const LegAxes<Lanes>& leg = group[g].leg;
    return friction_load(leg, legs.group[g].leg, rates, LegMotion<Lanes>(leg, rates, legs.joint));
  }
  /// By unit velocities of the platform joint and of the platform about it. Symmetric, since a joint's forces do work at
  /// its rates.
  FLEXAPOD_FLAT void set_friction() {
    SpatialInertia<Lanes> D{};
    for (int g = 0; g < leg_groups && of.friction; ++g) add_friction(g, D);
    C = sum(D).matrix();
  }
  void add_friction(int g, SpatialInertia<Lanes>& D) const {
    const auto by_velocity = [&](int j) {
      LegEnds<Lanes> rates{};
      rates.v = Vec3<Lanes>(axis(j));
      return friction_by(g, rates);
    };
    const auto moment_by_turn = [&](int j) {
      LegEnds<Lanes> rates{};
      rates.omega_p = Vec3<Lanes>(axis(j));
      return friction_by(g, rates).moment;
    };
    const SphericalLoad<Lanes> x = by_velocity(0), y = by_velocity(1), z = by_velocity(2);
    const Vec3<Lanes> about_x = moment_by_turn(0), about_y = moment_by_turn(1), about_z = moment_by_turn(2);
    const Vec3<Lanes>&F_x = x.force, &F_y = y.force, &F_z = z.force, &q = group[g].at.q_p;
    const Mat3<Lanes>&axes = group[g].leg.axes, out = transpose(axes);
    D.add(q, rotate(out, Sym3<Lanes>{F_x.x, F_y.y, F_z.z, F_x.y, F_x.z, F_y.z}));
    D.add_coupled(q, out * (transpose(Mat3<Lanes>{{-x.moment, -y.moment, -z.moment}}) * axes),
                  rotate(out, Sym3<Lanes>{-about_x.x, -about_y.y, -about_z.z, -about_x.y, -about_x.z, -about_y.z}));
  }
  FLEXAPOD_APART void add_suspension_stiffness() {
    using D = Dual<6>;
    const Motion<D> moved = at_rest(displaceable<D>(platform, 0));
    const Vec6<D> load = suspension_load(legs.design, moved, at_rest(constant<D>(base)));
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) K[i][j] += load[i].d[j];
  }
  /// By the rates of the platform, or by the turning of the base.
  FLEXAPOD_APART void add_suspension_damping(Mat6<double>& to, bool by_base) const {
    using D = Dual<6>;
    Motion<D> of_platform = at_rest(constant<D>(platform)), of_base = at_rest(constant<D>(base));
    Motion<D>& moving = by_base ? of_base : of_platform;
    moving.v = variables<D>(0), moving.w = variables<D>(3);
    const Vec6<D> lost = suspension_load(legs.design, of_platform, of_base);
    for (int i = 0; i < 6; ++i)
      for (int j = by_base ? 3 : 0; j < 6; ++j) to[i][j] += lost[i].d[j];
  }

  FLEXAPOD_FLAT void set_base_inertia(Mat6<double>& M_b) const {
    Mat6<Lanes> J_b;
    for (int g = 0; g < leg_groups; ++g)
      add_base_coupling(J_b, group[g].leg, legs.group[g].inertia, group[g].at.q_p, group[g].at.q_b, legs.joint);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) M_b[i][j] = -sum(J_b[i][j]);
  }
  /// Where the base moves without turning, rates are those of the platform, reversed.
  void set_base_damping(Mat6<double>& C_b) const {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 3; ++j) C_b[i][j] = -C[i][j], C_b[i][3 + j] = 0.0;
    for (int g = 0; g < leg_groups && of.friction; ++g) add_base_friction(g, C_b);
    if (legs.features.suspension) add_suspension_damping(C_b, true);
  }
  FLEXAPOD_FLAT void add_base_friction(int g, Mat6<double>& C_b) const {
    const Mat3<Lanes>& axes = group[g].leg.axes;
    for (int j = 0; j < 3; ++j) {
      const Vec3<Lanes> turn(axis(j));
      LegEnds<Lanes> rates{};
      rates.v = -(axes * cross(turn, group[g].at.q_b)), rates.omega_b = axes * turn;
      const SphericalLoad<Lanes> lost = friction_by(g, rates);
      const Vec3<Lanes> force = transposed(axes, lost.force), moment = transposed(axes, lost.moment);
      const Vec6<Lanes> wrench = Vec6<Lanes>::of(force, cross(group[g].at.q_p, force) - moment);
      for (int i = 0; i < 6; ++i) C_b[i][3 + j] += sum(wrench[i]);
    }
  }
};

}  // namespace flexapod
