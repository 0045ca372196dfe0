// The six legs at once, each in a lane of a hardware vector: the equations of motion as simulations need them, again and
// again. The legs' own equations are those of leg.hpp. A vector that is not full holds legs without inertia, friction or
// force beside the six.
#pragma once

#include "model/equations.hpp"
#include "model/reactions.hpp"
#include "simd/pack.hpp"

namespace flexapod {

using Lanes = Pack<Vector, 1>;
inline constexpr int leg_groups = (6 + Lanes::lanes - 1) / Lanes::lanes;  // vectors for six legs

inline Vec3<double> sum(const Vec3<Lanes>& v) { return {sum(v.x), sum(v.y), sum(v.z)}; }
inline Sym3<double> sum(const Sym3<Lanes>& m) {
  return {sum(m.xx), sum(m.yy), sum(m.zz), sum(m.xy), sum(m.xz), sum(m.yz)};
}
inline SpatialInertia<double> sum(const SpatialInertia<Lanes>& J) {
  return {
      sum(J.top), {{sum(J.bottom_left.row[0]), sum(J.bottom_left.row[1]), sum(J.bottom_left.row[2])}}, sum(J.bottom)};
}

/// J_p of Eq. 34, from the legs' part of it and the platform's rotation.
inline Mat6<double> inertia(const Design<double>& design, const Mat3<double>& R, const SpatialInertia<Lanes>& legs) {
  return (platform_inertia(design, R) + sum(legs)).matrix();
}

/// A number for each leg.
struct PerLeg {
  Lanes group[leg_groups];

  PerLeg() = default;
  explicit PerLeg(const Vec6<double>& x) {
    double lane[leg_groups * Lanes::lanes] = {};
    std::memcpy(lane, x.a, sizeof(x.a));
    for (int g = 0; g < leg_groups; ++g) group[g] = Lanes::load(lane + g * Lanes::lanes);
  }
  Vec6<double> six() const {
    double lane[leg_groups * Lanes::lanes];
    for (int g = 0; g < leg_groups; ++g) group[g].store(lane + g * Lanes::lanes);
    Vec6<double> x;
    std::memcpy(x.a, lane, sizeof(x.a));
    return x;
  }
};

/// Structures of doubles, one for each leg, as the same structure of lanes for one group; idle lanes hold `idle`.
template <class Many, class One> Many packed(int group, const One (&leg)[6], const One& idle) {
  static_assert(sizeof(Many) == sizeof(One) / sizeof(double) * sizeof(Lanes));
  constexpr size_t numbers = sizeof(One) / sizeof(double);
  double number[Lanes::lanes][numbers], lane[Lanes::lanes];
  for (int i = 0; i < Lanes::lanes; ++i) {
    const int which = group * Lanes::lanes + i;
    std::memcpy(number[i], which < 6 ? &leg[which] : &idle, sizeof(One));
  }
  Many many;
  for (size_t n = 0; n < numbers; ++n) {
    for (int i = 0; i < Lanes::lanes; ++i) lane[i] = number[i][n];
    std::memcpy(reinterpret_cast<char*>(&many) + n * sizeof(Lanes), lane, sizeof(Lanes));
  }
  return many;
}

/// Where a group of legs is, in the axes of the motions that go with it: joints from the reference points, leg vectors,
/// universal axes.
struct GroupPlaces {
  Vec3<Lanes> q_p, q_b, S, k;
};

/// A design as its equations of motion take it.
struct SixLegs {
  struct Group {
    Leg<Lanes> leg;
    LegInertia<Lanes> inertia;
    Vec3<Lanes> b, k, p;

    GroupPlaces places(const Pose<double>& platform, const Pose<double>& base) const {
      const Vec3<Lanes> q_p = platform.R * p, q_b = base.R * b;
      return {q_p, q_b, (platform.t - base.t) + q_p - q_b, base.R * k};
    }
  };
  struct Joints {  // set where they have springs
    LegSprings<Lanes> springs;
    JointRest<Lanes> rest;
  };
  Design<double> design;
  Joint joint;
  Features features;
  Group group[leg_groups];
  Joints joints[leg_groups];

  explicit SixLegs(const Machine<double>& m) : design(m.design), joint(m.joint), features(m.features) {
    for (int g = 0; g < leg_groups; ++g)
      group[g] = {packed<Leg<Lanes>>(g, m.design.leg, Leg<double>{}),
                  packed<LegInertia<Lanes>>(g, m.inertia, LegInertia<double>{}),
                  packed<Vec3<Lanes>>(g, m.design.b, m.design.b[0]), packed<Vec3<Lanes>>(g, m.design.k, m.design.k[0]),
                  packed<Vec3<Lanes>>(g, m.design.p, m.design.p[0])};
    if (features.joints)
      for (int g = 0; g < leg_groups; ++g)
        joints[g] = {packed<LegSprings<Lanes>>(g, m.design.springs, LegSprings<double>{}),
                     packed<JointRest<Lanes>>(g, m.rest, m.rest[0])};
  }
  /// Adds the moments of the joints' springs to what a group's spherical joints carry.
  void add_springs(SphericalLoad<Lanes>& load, int g, const LegAxes<Lanes>& leg, const Vec3<Lanes>& axis,
                   const Mat3<double>& R_p, const Mat3<double>& R_b) const {
    add_joint_springs(load, joints[g].springs, joints[g].rest, leg, axis, R_p, R_b, joint);
  }
};

/// Where all are.
struct LegPlaces {
  GroupPlaces group[leg_groups];

  LegPlaces() = default;
  LegPlaces(const SixLegs& legs, const Pose<double>& platform, const Pose<double>& base)
      : LegPlaces(legs, platform, base, std::make_integer_sequence<int, leg_groups>()) {}

 private:  // made in their place: vectors that are zeroed first and copied then take longer than what they hold
  template <int... g>
  LegPlaces(const SixLegs& legs, const Pose<double>& platform, const Pose<double>& base,
            std::integer_sequence<int, g...>)
      : group{legs.group[g].places(platform, base)...} {}
};

/// Sets the columns of H that belong to a group.
inline void set_force_transformation(Mat6<double>& H, int g, const GroupPlaces& at, const LegAxes<Lanes>& leg) {
  const Vec6<Lanes> h = leg_wrench(at.q_p, leg.s());
  for (int r = 0; r < 6; ++r) {
    double lane[Lanes::lanes];
    h[r].store(lane);
    for (int i = 0; i < Lanes::lanes && g * Lanes::lanes + i < 6; ++i) H[r][g * Lanes::lanes + i] = lane[i];
  }
}

/// What legs add to J_p, and the wrench that they take from a platform with the accelerations given.
struct LegSums {
  SpatialInertia<Lanes> J;
  Vec3<Lanes> force, moment;

  FLEXAPOD_FLAT void add(const SixLegs& legs, int g, const GroupPlaces& at, const Motion<double>& platform,
                         const Motion<double>& base, const Lanes& leg_force) {
    const LegAxes<Lanes> leg(at.S, at.k, legs.joint);
    add_load(legs, g, at, leg, platform, base, leg_force);
    add_leg_inertia(J, leg, legs.group[g].inertia, at.q_p);
  }
  void add_load(const SixLegs& legs, int g, const GroupPlaces& at, const LegAxes<Lanes>& leg,
                const Motion<double>& platform, const Motion<double>& base, const Lanes& leg_force) {
    const SixLegs::Group& group = legs.group[g];
    const LegEnds<Lanes> end = leg_ends(leg, at.q_p, at.q_b, platform, base, legs.design.gravity);
    const LegMotion<Lanes> motion(leg, end, legs.joint);
    SphericalLoad<Lanes> load = spherical_load(leg, group.inertia, group.leg, end, motion);
    load.force.x -= leg_force;
    const Vec3<Lanes> F_s = transposed(leg.axes, load.force);
    force += F_s;
    moment += cross(at.q_p, F_s) - transposed(leg.axes, load.moment);
  }
  /// The part of the springs in the joints; apart, so that a machine without them goes through nothing new.
  FLEXAPOD_APART void add_springs(const SixLegs& legs, int g, const GroupPlaces& at, const Motion<double>& platform,
                                  const Motion<double>& base) {
    const LegAxes<Lanes> leg(at.S, at.k, legs.joint);
    SphericalLoad<Lanes> load{};
    const Lanes zero(0.0);
    load.force = load.moment = Vec3<Lanes>(zero, zero, zero);
    legs.add_springs(load, g, leg, at.k, platform.pose.R, base.pose.R);
    const Vec3<Lanes> F_s = transposed(leg.axes, load.force);
    force += F_s;
    moment += cross(at.q_p, F_s) - transposed(leg.axes, load.moment);
  }
};

/// Takes the wrench against the suspension from that on the platform.
FLEXAPOD_APART inline void subtract_suspension_load(Vec6<double>& wrench, const Design<double>& d,
                                                    const Motion<double>& platform, const Motion<double>& base) {
  const Vec6<double> load = suspension_load(d, platform, base);
  for (int i = 0; i < 6; ++i) wrench[i] -= load[i];
}

/// Eq. 35's accelerations of the platform: J_p^-1 (H F + wrench - eta + J_b [a_b; alpha_b]).
FLEXAPOD_FLAT inline Vec6<double> forward_dynamics(const SixLegs& legs, const LegPlaces& at, Motion<double> platform,
                                                   const Motion<double>& base, const PerLeg& leg_force,
                                                   Vec6<double> wrench) {
  platform = unaccelerated(platform);
  if (legs.features.suspension) subtract_suspension_load(wrench, legs.design, platform, base);
  LegSums sums{};
  for (int g = 0; g < leg_groups; ++g) sums.add(legs, g, at.group[g], platform, base, leg_force.group[g]);
  if (legs.features.joints)
    for (int g = 0; g < leg_groups; ++g) sums.add_springs(legs, g, at.group[g], platform, base);
  Vec6<double> load = platform_wrench(legs.design, platform);
  add(load, sum(sums.force), sum(sums.moment));
  for (int i = 0; i < 6; ++i) load[i] = wrench[i] - load[i];
  return solve_positive(inertia(legs.design, platform.pose.R, sums.J), load);
}

/// The same from poses.
inline Vec6<double> forward_dynamics(const SixLegs& legs, const Motion<double>& platform, const Motion<double>& base,
                                     const Vec6<double>& leg_force, const Vec6<double>& wrench) {
  return forward_dynamics(legs, LegPlaces(legs, platform.pose, base.pose), platform, base, PerLeg(leg_force), wrench);
}

/// Leg forces that give the accelerations of `platform`, from H F = load - wrench; NaN where H is singular.
FLEXAPOD_FLAT inline Vec6<double> inverse_dynamics(const SixLegs& legs, const Motion<double>& platform,
                                                   const Motion<double>& base, const Vec6<double>& wrench) {
  const LegPlaces at(legs, platform.pose, base.pose);
  LegSums sums{};
  Mat6<double> H;
  for (int g = 0; g < leg_groups; ++g) {
    const LegAxes<Lanes> leg(at.group[g].S, at.group[g].k, legs.joint);
    sums.add_load(legs, g, at.group[g], leg, platform, base, Lanes(0.0));
    set_force_transformation(H, g, at.group[g], leg);
  }
  if (legs.features.joints)
    for (int g = 0; g < leg_groups; ++g) sums.add_springs(legs, g, at.group[g], platform, base);
  Vec6<double> load = platform_wrench(legs.design, platform), force;
  add(load, sum(sums.force), sum(sums.moment));
  for (int i = 0; i < 6; ++i) load[i] -= wrench[i];
  if (legs.features.suspension) add_suspension_load(load, legs.design, platform, base);
  if (!solve_general(H, load, force)) force = Vec6<double>{{NAN, NAN, NAN, NAN, NAN, NAN}};
  return force;
}

/// What the machine does to its base and loses to friction, for the accelerations in the motions given.
struct BaseLoad {
  Vec3<double> force, moment;  // on the base, moment about its reference point
  double dissipation = 0;      // W

  BaseLoad(const SixLegs& legs, const LegPlaces& at, const Motion<double>& platform, const Motion<double>& base,
           const PerLeg& leg_force) {
    Vec3<Lanes> f, m;
    Lanes lost(0.0);
    for (int g = 0; g < leg_groups; ++g) add(legs, g, at.group[g], platform, base, leg_force.group[g], f, m, lost);
    force = sum(f), moment = sum(m), dissipation = sum(lost);
    if (legs.features.suspension) add_suspension(legs.design, platform, base);
  }

 private:
  void add_suspension(const Design<double>& design, const Motion<double>& platform, const Motion<double>& base) {
    const Vec6<double> load = suspension_load(design, platform, base);
    force += load.top(), moment += cross(platform.pose.t - base.pose.t, load.top()) + load.bottom();
    dissipation += suspension_loss(design, platform, base);
  }
  FLEXAPOD_FLAT static void add(const SixLegs& legs, int g, const GroupPlaces& at, const Motion<double>& platform,
                                const Motion<double>& base, const Lanes& leg_force, Vec3<Lanes>& force,
                                Vec3<Lanes>& moment, Lanes& dissipation) {
    const SixLegs::Group& group = legs.group[g];
    const LegAxes<Lanes> leg(at.S, at.k, legs.joint);
    const LegEnds<Lanes> end = leg_ends(leg, at.q_p, at.q_b, platform, base, legs.design.gravity);
    const LegMotion<Lanes> motion(leg, end, legs.joint);
    SphericalLoad<Lanes> load = spherical_load(leg, group.inertia, group.leg, end, motion);
    if (legs.features.joints) legs.add_springs(load, g, leg, at.k, platform.pose.R, base.pose.R);
    const LegReactions<Lanes> r = leg_reactions(group.leg, group.inertia, leg, end, motion, load, leg_force, 0.5);
    force += r.universal_force;
    moment += cross(at.q_b, r.universal_force) + r.universal_moment;
    dissipation += friction_power(group.leg, joint_rates(end, motion));
  }
};

}  // namespace flexapod
