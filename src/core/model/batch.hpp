// The mechanics of one machine at many states: a row of results for each.
#pragma once

#include <tuple>

#include "model/energy.hpp"
#include "model/frequency_derivatives.hpp"
#include "model/kinematics.hpp"
#include "model/leg_distance.hpp"
#include "model/reactions.hpp"
#include "model/statics.hpp"
#include "numbers/array.hpp"

namespace flexapod {

/// Motions of platform and base for n states.
struct States {
  std::size_t n;
  const Motion<double>*platform, *base;
};

}  // namespace flexapod

namespace flexapod::batch {

using Rows = Array<double>;
using LegRows = const double (*)[6];  // rows of one number for each leg

inline void write(double*& to, const Vec3<double>& v) {
  for (const double x : {v.x, v.y, v.z}) *to++ = x;
}
inline void write(double*& to, const Vec6<double>& v) {
  for (const double x : v.a) *to++ = x;
}
template <int columns> void write(double*& to, const Mat6<double, columns>& m) {
  for (const auto& row : m.a)
    for (const double x : row) *to++ = x;
}
inline void write(double*& to, const double (&values)[6]) {
  for (const double x : values) *to++ = x;
}
inline void write(double*& to, const Pose<double>& pose) {
  write(to, pose.t);
  for (const auto& row : pose.R.row) write(to, row);
}

inline Geometry<double> geometry(const Machine<double>& machine, const States& s, std::size_t i) {
  return {machine.design, s.platform[i].pose, s.base[i].pose};
}

/// Calls f(i, to...) for every state, with a pointer into each array that f moves on as it writes.
template <class F, class... A> void for_each_state(const States& s, F&& f, const A&... arrays) {
  std::tuple to{arrays.data()...};
  for (std::size_t i = 0; i < s.n; ++i) std::apply([&](auto&... pointers) { f(i, pointers...); }, to);
}

/// Lengths and their first two derivatives, (n, 6) each.
inline auto leg_rates(const Machine<double>& machine, const States& s) {
  Rows length({s.n, 6}), rate({s.n, 6}), acceleration({s.n, 6});
  for_each_state(
      s,
      [&](std::size_t i, double*& l, double*& v, double*& a) {
        const LegRates rates(geometry(machine, s, i), s.platform[i], s.base[i]);
        write(l, rates.L), write(v, rates.L_dot), write(a, rates.L_ddot);
      },
      length, rate, acceleration);
  return std::tuple{std::move(length), std::move(rate), std::move(acceleration)};
}

/// Lengths and the sine of the angle to the universal axis, (n, 6) each.
inline auto leg_fit(const Machine<double>& machine, const States& s) {
  Rows length({s.n, 6}), sine({s.n, 6});
  for_each_state(
      s,
      [&](std::size_t i, double*& l, double*& k) {
        const LegFit fit(geometry(machine, s, i));
        write(l, fit.length), write(k, fit.sine);
      },
      length, sine);
  return std::tuple{std::move(length), std::move(sine)};
}

/// The two angles of the universal joints, and those of both joints from neutral directions, (n, 6) each.
inline auto joint_angles(const Machine<double>& machine, const States& s, const Vec3<double> (&in_base)[6],
                         const Vec3<double> (&in_platform)[6]) {
  Rows first({s.n, 6}), second({s.n, 6}), universal({s.n, 6}), spherical({s.n, 6});
  for_each_state(
      s,
      [&](std::size_t i, double*& f, double*& t, double*& u, double*& p) {
        const JointAngles angles(geometry(machine, s, i), s.platform[i].pose, s.base[i].pose, in_base, in_platform);
        write(f, angles.first), write(t, angles.second), write(u, angles.universal), write(p, angles.spherical);
      },
      first, second, universal, spherical);
  return std::tuple{std::move(first), std::move(second), std::move(universal), std::move(spherical)};
}

/// Of every pair of legs, (n, 15).
inline Rows leg_distances(const Machine<double>& machine, const States& s) {
  const SharedJoints shared(machine.design);
  Rows distance({s.n, leg_pairs});
  for_each_state(
      s,
      [&](std::size_t n, double*& to) {
        const Geometry<double> g = geometry(machine, s, n);
        for_leg_pairs([&](int pair, int i, int j) { *to++ = pair_distance(g, shared, pair, i, j); });
      },
      distance);
  return distance;
}

/// 1 for every pair of legs whose joints on a plate are at one point, else 0, (15,).
inline Rows shared_joints(const EachLeg<Vec3<double>>& joints) {
  bool shared[leg_pairs];
  flexapod::shared_joints(joints, shared);
  Rows found({leg_pairs});
  std::copy_n(shared, leg_pairs, found.data());
  return found;
}

/// Poses (n, 12) that have the lengths, and the errors left (n,), m.
inline auto forward_kinematics(const Machine<double>& machine, std::size_t n, LegRows lengths,
                               const Motion<double>* start) {
  Rows poses({n, pose_size}), errors({n});
  double* to = poses.data();
  for (std::size_t i = 0; i < n; ++i) {
    const FoundPose found = flexapod::forward_kinematics(machine.design, lengths[i], start[i].pose);
    write(to, found.pose);
    errors.data()[i] = found.error;
  }
  return std::tuple{std::move(poses), std::move(errors)};
}

inline Rows force_transformation(const Machine<double>& machine, const States& s) {
  Rows H({s.n, 6, 6});
  for_each_state(
      s, [&](std::size_t i, double*& to) { write(to, flexapod::force_transformation(geometry(machine, s, i))); }, H);
  return H;
}

/// F, (n, 6, springs): K = F F^T. Those of joints and suspension are left out where there are none.
inline Rows spring_matrix(const Machine<double>& machine, const States& s) {
  const bool all = machine.features.others();
  Rows F({s.n, 6, static_cast<std::size_t>(all ? all_springs : spring_count)});
  for_each_state(
      s,
      [&](std::size_t i, double*& to) {
        const Geometry<double> g = geometry(machine, s, i);
        if (all) write(to, flexapod::spring_matrix(machine, g, s.platform[i].pose.R, s.base[i].pose.R));
        else write(to, leg_spring_matrix(machine, g));
      },
      F);
  return F;
}

/// Axial stiffness of legs of these lengths and its derivative by them, (n, 6) each.
inline auto axial_stiffness(const Machine<double>& machine, std::size_t n, LegRows length) {
  using D = Dual<1>;
  Rows stiffness({n, 6}), slope({n, 6});
  double *k = stiffness.data(), *by = slope.data();
  for (std::size_t i = 0; i < 6 * n; ++i) {
    const D found = machine.stiffness(static_cast<int>(i % 6), D::variable(length[i / 6][i % 6], 0));
    *k++ = found.v, *by++ = found.d[0];
  }
  return std::tuple{std::move(stiffness), std::move(slope)};
}

/// Unstretched lengths (n, 6) of legs with these lengths and forces; NaN where there are none.
inline Rows unstretched_lengths(const Machine<double>& machine, std::size_t n, LegRows length, LegRows force) {
  Rows found({n, 6});
  double* to = found.data();
  for (std::size_t i = 0; i < n; ++i)
    for (int leg = 0; leg < 6; ++leg) *to++ = unstretched_length(machine, leg, length[i][leg], force[i][leg]);
  return found;
}

/// J_p, J_b (n, 6, 6), eta (n, 6) and H (n, 6, 6).
inline auto equations_of_motion(const Machine<double>& machine, const States& s) {
  Rows J_p({s.n, 6, 6}), J_b({s.n, 6, 6}), eta({s.n, 6}), H({s.n, 6, 6});
  for_each_state(
      s,
      [&](std::size_t i, double*& jp, double*& jb, double*& e, double*& h) {
        const Geometry<double> g = geometry(machine, s, i);
        write(jp, inertia(machine, g, s.platform[i].pose.R));
        write(jb, base_coupling(machine, g));
        write(e, inverse_wrench(machine, g, unaccelerated(s.platform[i]), unaccelerated(s.base[i])));
        write(h, flexapod::force_transformation(g));
      },
      J_p, J_b, eta, H);
  return std::tuple{std::move(J_p), std::move(J_b), std::move(eta), std::move(H)};
}

/// Leg forces for the accelerations given; NaN where H is singular.
inline Rows inverse_dynamics(const Machine<double>& machine, const States& s, const Vec6<double>* loads) {
  Rows forces({s.n, 6});
  for_each_state(
      s,
      [&](std::size_t i, double*& to) {
        const Vec6<double> external = external_wrench(s.platform[i].pose.R, loads[i]);
        write(to, flexapod::inverse_dynamics(machine, geometry(machine, s, i), s.platform[i], s.base[i], external));
      },
      forces);
  return forces;
}

/// Forces and moments of every leg (n, 6, 6 kinds, 3) and their total on the base (n, 2, 3).
inline auto joint_reactions(const Machine<double>& machine, const States& s, const Vec6<double>* forces,
                            double section) {
  Rows legs({s.n, 6, 6, 3}), total({s.n, 2, 3});
  for_each_state(
      s,
      [&](std::size_t i, double*& leg_to, double*& total_to) {
        const Reactions r = reactions(machine, s.platform[i], s.base[i], forces[i], section);
        for (const LegReactions<double>& leg : r.leg)
          for (const auto& v : {leg.spherical_force, leg.spherical_moment, leg.prismatic_force, leg.prismatic_moment,
                                leg.universal_force, leg.universal_moment})
            write(leg_to, v);
        write(total_to, r.base_force), write(total_to, r.base_moment);
      },
      legs, total);
  return std::tuple{std::move(legs), std::move(total)};
}

/// Of the springs in every leg's joints: angles (n, 6, 4) and moments (n, 6, 4), about the universal joint's two axes, of
/// the bending at the platform and of the twist.
inline auto joint_moments(const Machine<double>& machine, const States& s) {
  Rows angles({s.n, 6, 4}), moments({s.n, 6, 4});
  for_each_state(
      s,
      [&](std::size_t n, double*& a, double*& m) {
        const Geometry<double> g = geometry(machine, s, n);
        for (int i = 0; i < 6; ++i) {
          const LegSprings<double>& k = machine.design.springs[i];
          const JointSprings<double> of(k, JointRest<double>(machine.design, i),
                                        LegAxes<double>(g.S[i], g.k[i], machine.joint), g.k[i], s.platform[n].pose.R,
                                        s.base[n].pose.R, machine.joint);
          const double angle[] = {of.first, of.second, std::sqrt(of.bend_2), of.twist};
          const double stiffness[] = {k.k_u[0], k.k_u[1], k.k_s, k.k_t};
          for (int j = 0; j < 4; ++j) *a++ = angle[j], *m++ = stiffness[j] * angle[j];
        }
      },
      angles, moments);
  return std::tuple{std::move(angles), std::move(moments)};
}

/// Kinetic and gravitational energy, elastic energy of legs, joints and suspension, and dissipated power, (n, 6).
inline Rows energy(const Machine<double>& machine, const States& s, LegRows unstretched) {
  Rows energies({s.n, 6});
  for_each_state(
      s,
      [&](std::size_t i, double*& to) {
        const Energy e = flexapod::energy(machine, s.platform[i], s.base[i], unstretched[i]);
        for (const double x : {e.kinetic, e.gravitational, e.legs, e.joints, e.suspension, e.dissipation}) *to++ = x;
      },
      energies);
  return energies;
}

/// Frequencies (n, 6) and shapes (n, 6, 6).
inline auto natural_modes(const Machine<double>& machine, const States& s) {
  Rows omega({s.n, 6}), shape({s.n, 6, 6});
  for_each_state(
      s,
      [&](std::size_t i, double*& w, double*& v) {
        const Modes modes =
            flexapod::natural_modes(machine, geometry(machine, s, i), s.platform[i].pose.R, s.base[i].pose.R);
        write(w, modes.omega), write(v, modes.shape);
      },
      omega, shape);
  return std::tuple{std::move(omega), std::move(shape)};
}

/// J_plat (n, 6, 6), and each leg's J_p_i (n, 6, 6, 6), for energy shares.
inline auto inertia_parts(const Machine<double>& machine, const States& s) {
  Rows platform({s.n, 6, 6}), legs({s.n, 6, 6, 6});
  for_each_state(
      s,
      [&](std::size_t i, double*& p, double*& l) {
        const Geometry<double> g = geometry(machine, s, i);
        write(p, platform_inertia(machine.design, s.platform[i].pose.R).matrix());
        for (int j = 0; j < 6; ++j) {
          SpatialInertia<double> J;
          add_leg_inertia(J, machine, g, j);
          write(l, J.matrix());
        }
      },
      platform, legs);
  return std::tuple{std::move(platform), std::move(legs)};
}

/// Derivatives of omega^2 by the design's numbers (n, 6, design_size) and by the platform's displacement (n, 6, 6).
inline auto frequency_derivatives(const Machine<double>& machine, const States& s) {
  Rows by_design({s.n, 6, design_size}), by_pose({s.n, 6, 6});
  double* to = by_pose.data();
  for (std::size_t i = 0; i < s.n; ++i) {
    const Pose<double>&platform = s.platform[i].pose, &base = s.base[i].pose;
    const Modes modes = flexapod::natural_modes(machine, geometry(machine, s, i), platform.R, base.R);
    auto* block = reinterpret_cast<double (*)[design_size]>(by_design.data() + i * 6 * design_size);
    design_derivatives(machine, platform, base, modes, block);
    write(to, pose_derivatives(machine, platform, base, modes));
  }
  return std::tuple{std::move(by_design), std::move(by_pose)};
}

/// The pose (12,) where the platform settles from the one given, and how the search ended.
inline auto settle(const Machine<double>& machine, const States& s, const RestLoad& load) {
  Pose<double> pose = s.platform->pose;
  const Rest end = flexapod::settle(machine, s.base->pose, load, pose);
  Rows found({pose_size});
  double* to = found.data();
  write(to, pose);
  return std::tuple{std::move(found), end};
}

}  // namespace flexapod::batch
