// The core as Python sees it: functions of a design (211 numbers) and motions (n rows of 24 numbers) that return
// arrays with n rows. Shapes and values are checked in Python; here only sizes are.
#include "bindings/arrays.hpp"
#include "bindings/designs.hpp"
#include "bindings/simulation.hpp"
#include "bindings/sweep.hpp"
#include "bindings/types.hpp"
#include "model/energy.hpp"
#include "model/kinematics.hpp"
#include "model/modes.hpp"
#include "model/reactions.hpp"
#include "model/statics.hpp"

namespace flexapod {
namespace {

/// Platform and base motions for n poses.
struct States {
  size_t n;
  const Motion<double>*platform, *base;

  States(const Input& platforms, const Input& bases)
      : n(platforms.size() / motion_size),
        platform(motions(platforms, n, "platform")),
        base(motions(bases, n, "base")) {}
};

Geometry<double> geometry(const Machine<double>& machine, const States& s, size_t i) {
  return {machine.design, s.platform[i].pose, s.base[i].pose};
}

nb::tuple leg_rates(const Input& design, const Input& platforms, const Input& bases) {
  const Machine<double> machine = machine_of(design);
  const States s(platforms, bases);
  Output L({s.n, 6}), L_dot({s.n, 6}), L_ddot({s.n, 6});
  double *l = L.data(), *v = L_dot.data(), *a = L_ddot.data();
  for (size_t i = 0; i < s.n; ++i) {
    const LegRates rates(geometry(machine, s, i), s.platform[i], s.base[i]);
    write(l, rates.L), write(v, rates.L_dot), write(a, rates.L_ddot);
  }
  return nb::make_tuple(L.array(), L_dot.array(), L_ddot.array());
}

nb::tuple leg_fit(const Input& design, const Input& platforms, const Input& bases) {
  const Machine<double> machine = machine_of(design);
  const States s(platforms, bases);
  Output length({s.n, 6}), sine({s.n, 6});
  double *l = length.data(), *k = sine.data();
  for (size_t i = 0; i < s.n; ++i) {
    const LegFit fit(geometry(machine, s, i));
    write(l, fit.length), write(k, fit.sine);
  }
  return nb::make_tuple(length.array(), sine.array());
}

nb::tuple joint_angles(const Input& design, const Input& platforms, const Input& bases, const Input& neutral) {
  const Machine<double> machine = machine_of(design);
  const States s(platforms, bases);
  using Directions = const Vec3<double>(&)[6];
  const double* directions = rows(neutral, 2, 18, "neutral");
  Directions in_base = *reinterpret_cast<const Vec3<double>(*)[6]>(directions);
  Directions in_platform = *reinterpret_cast<const Vec3<double>(*)[6]>(directions + 18);
  Output first({s.n, 6}), second({s.n, 6}), universal({s.n, 6}), spherical({s.n, 6});
  double *f = first.data(), *t = second.data(), *u = universal.data(), *p = spherical.data();
  for (size_t i = 0; i < s.n; ++i) {
    const JointAngles angles(geometry(machine, s, i), s.platform[i].pose, s.base[i].pose, in_base, in_platform);
    write(f, angles.first), write(t, angles.second), write(u, angles.universal), write(p, angles.spherical);
  }
  return nb::make_tuple(first.array(), second.array(), universal.array(), spherical.array());
}

nb::object leg_distance(const Input& design, const Input& platforms, const Input& bases) {
  const Machine<double> machine = machine_of(design);
  const States s(platforms, bases);
  Output distance({s.n});
  for (size_t i = 0; i < s.n; ++i) {
    const Geometry<double> g = geometry(machine, s, i);
    distance.data()[i] = least_leg_distance(g);
  }
  return nb::cast(distance.array());
}

nb::tuple forward_kinematics_(const Input& design, const Input& lengths, const Input& starts) {
  const Machine<double> machine = machine_of(design);
  const size_t n = lengths.size() / 6;
  const double* length = rows(lengths, n, 6, "lengths");
  const Motion<double>* start = motions(starts, n, "start");
  Output poses({n, 12}), errors({n});
  double* out = poses.data();
  for (size_t i = 0; i < n; ++i) {
    const auto& wanted = *reinterpret_cast<const double (*)[6]>(length + 6 * i);
    const FoundPose found = forward_kinematics(machine.design, wanted, start[i].pose);
    write(out, found.pose);
    errors.data()[i] = found.error;
  }
  return nb::make_tuple(poses.array(), errors.array());
}

nb::object force_transformation_(const Input& design, const Input& platforms, const Input& bases) {
  const Machine<double> machine = machine_of(design);
  const States s(platforms, bases);
  Output H({s.n, 6, 6});
  double* out = H.data();
  for (size_t i = 0; i < s.n; ++i) write(out, force_transformation(geometry(machine, s, i)));
  return nb::cast(H.array());
}

/// F: n matrices with one column for each spring.
nb::object spring_matrix(const Input& design, const Input& platforms, const Input& bases) {
  const Machine<double> machine = machine_of(design);
  const RootStiffness<double> root(machine.design);
  const States s(platforms, bases);
  Output F({s.n, 6, size_t{spring_count}});
  double* out = F.data();
  for (size_t i = 0; i < s.n; ++i) write(out, root.scaled(spring_directions(geometry(machine, s, i))));
  return nb::cast(F.array());
}

/// The leg of each spring.
nb::tuple spring_legs() {
  nb::list legs;
  for (int j = 0; j < spring_count; ++j) legs.append(spring_leg(j));
  return nb::tuple(legs);
}

nb::tuple equations_of_motion(const Input& design, Joint joint, const Input& platforms, const Input& bases) {
  const Machine<double> machine = machine_of(design, joint);
  const States s(platforms, bases);
  Output J_p({s.n, 6, 6}), J_b({s.n, 6, 6}), eta({s.n, 6}), H({s.n, 6, 6});
  double *jp = J_p.data(), *jb = J_b.data(), *e = eta.data(), *h = H.data();
  for (size_t i = 0; i < s.n; ++i) {
    const Geometry<double> g = geometry(machine, s, i);
    write(jp, inertia(machine, g, s.platform[i].pose.R));
    write(jb, base_coupling(machine, g));
    write(e, inverse_wrench(machine, g, unaccelerated(s.platform[i]), unaccelerated(s.base[i])));
    write(h, force_transformation(g));
  }
  return nb::make_tuple(J_p.array(), J_b.array(), eta.array(), H.array());
}

nb::object forward_dynamics_(const Input& design, Joint joint, const Input& platforms, const Input& bases,
                             const Input& leg_forces, const Input& wrenches) {
  const States s(platforms, bases);
  const double *F = rows(leg_forces, s.n, 6, "leg_force"), *load = rows(wrenches, s.n, 6, "wrench");
  Output acceleration({s.n, 6});
  simulation_kernel_in_use().forward_dynamics({rows(design, 1, design_size, "design"), joint, s.n, platforms.data(),
                                               bases.data(), F, load, acceleration.data()});
  return nb::cast(acceleration.array());
}

/// Leg forces for the accelerations given; NaN where H is singular.
nb::object inverse_dynamics_(const Input& design, Joint joint, const Input& platforms, const Input& bases,
                             const Input& wrenches) {
  const Machine<double> machine = machine_of(design, joint);
  const States s(platforms, bases);
  const double* load = rows(wrenches, s.n, 6, "wrench");
  Output forces({s.n, 6});
  double* out = forces.data();
  for (size_t i = 0; i < s.n; ++i) {
    const Geometry<double> g = geometry(machine, s, i);
    const Vec6<double> external = external_wrench(s.platform[i].pose.R, vec6(load + 6 * i));
    write(out, inverse_dynamics(machine, g, s.platform[i], s.base[i], external));
  }
  return nb::cast(forces.array());
}

/// Rows of 6 legs x 6 vectors x 3, and the total force and moment on the base.
nb::tuple joint_reactions(const Input& design, Joint joint, const Input& platforms, const Input& bases,
                          const Input& leg_forces, double section) {
  const Machine<double> machine = machine_of(design, joint);
  const States s(platforms, bases);
  const double* F = rows(leg_forces, s.n, 6, "leg_force");
  Output legs({s.n, 6, 6, 3}), total({s.n, 2, 3});
  double *leg_out = legs.data(), *total_out = total.data();
  for (size_t i = 0; i < s.n; ++i) {
    const Reactions r = reactions(machine, s.platform[i], s.base[i], vec6(F + 6 * i), section);
    for (const LegReactions<double>& leg : r.leg)
      for (const auto& v : {leg.spherical_force, leg.spherical_moment, leg.prismatic_force, leg.prismatic_moment,
                            leg.universal_force, leg.universal_moment})
        write(leg_out, v);
    write(total_out, r.base_force), write(total_out, r.base_moment);
  }
  return nb::make_tuple(legs.array(), total.array());
}

/// Rows of kinetic, gravitational, elastic energy and dissipated power.
nb::object energy_(const Input& design, Joint joint, const Input& platforms, const Input& bases,
                   const Input& unstretched) {
  const Machine<double> machine = machine_of(design, joint);
  const States s(platforms, bases);
  const double* L_0 = rows(unstretched, s.n, 6, "unstretched");
  Output energies({s.n, 4});
  double* out = energies.data();
  for (size_t i = 0; i < s.n; ++i) {
    const auto& lengths = *reinterpret_cast<const double (*)[6]>(L_0 + 6 * i);
    const Energy e = energy(machine, s.platform[i], s.base[i], lengths);
    for (const double x : {e.kinetic, e.gravitational, e.elastic, e.dissipation}) *out++ = x;
  }
  return nb::cast(energies.array());
}

nb::tuple natural_modes_(const Input& design, Joint joint, const Input& platforms, const Input& bases) {
  const Machine<double> machine = machine_of(design, joint);
  const States s(platforms, bases);
  Output omega({s.n, 6}), shape({s.n, 6, 6});
  double *w = omega.data(), *v = shape.data();
  for (size_t i = 0; i < s.n; ++i) {
    const Modes modes = natural_modes(machine, geometry(machine, s, i), s.platform[i].pose.R);
    write(w, modes.omega), write(v, modes.shape);
  }
  return nb::make_tuple(omega.array(), shape.array());
}

/// J_plat, and each leg's J_p_i, for energy shares.
nb::tuple inertia_parts(const Input& design, Joint joint, const Input& platforms, const Input& bases) {
  const Machine<double> machine = machine_of(design, joint);
  const States s(platforms, bases);
  Output platform({s.n, 6, 6}), legs({s.n, 6, 6, 6});
  double *p = platform.data(), *l = legs.data();
  for (size_t i = 0; i < s.n; ++i) {
    const Geometry<double> g = geometry(machine, s, i);
    write(p, platform_inertia(machine.design, s.platform[i].pose.R).matrix());
    for (int j = 0; j < 6; ++j) {
      SpatialInertia<double> J;
      add_leg_inertia(J, machine, g, j);
      write(l, J.matrix());
    }
  }
  return nb::make_tuple(platform.array(), legs.array());
}

/// Derivatives of omega^2: (n, 6, 211) by the design's numbers and (n, 6, 6) by the platform's displacement.
nb::tuple frequency_derivatives(const Input& design, Joint joint, const Input& platforms, const Input& bases) {
  const Machine<double> machine = machine_of(design, joint);
  const States s(platforms, bases);
  Output by_design({s.n, 6, design_size}), by_pose({s.n, 6, 6});
  double* pose_out = by_pose.data();
  for (size_t i = 0; i < s.n; ++i) {
    const Pose<double>&platform = s.platform[i].pose, &base = s.base[i].pose;
    const Modes modes = natural_modes(machine, geometry(machine, s, i), platform.R);
    auto* block = reinterpret_cast<double (*)[design_size]>(by_design.data() + i * 6 * design_size);
    design_derivatives(machine.design, machine.joint, platform, base, modes, block);
    write(pose_out, pose_derivatives(machine, platform, base, modes));
  }
  return nb::make_tuple(by_design.array(), by_pose.array());
}

/// M, C, K, M_b, C_b, K_b, H at rest with the wrench and the unstretched lengths given.
nb::tuple tangent_(const Input& design, Joint joint, const Input& platform, const Input& base, const Input& wrench,
                   const Input& unstretched) {
  const Machine<double> machine = machine_of(design, joint);
  RestLoad load{vec6(rows(wrench, 1, 6, "wrench")), {}};
  std::copy_n(rows(unstretched, 1, 6, "unstretched"), 6, load.L_0);
  const States s(platform, base);
  const Tangent t = tangent(machine, s.platform->pose, s.base->pose, load);
  nb::list matrices;
  for (const Mat6<double>& m : {t.M, t.C, t.K, t.M_b, t.C_b, t.K_b, t.H}) {
    Output matrix({6, 6});
    double* out = matrix.data();
    write(out, m);
    matrices.append(matrix.array());
  }
  return nb::tuple(matrices);
}

/// The pose (12 numbers) where the platform settles, and how the search ended.
nb::tuple settle_(const Input& design, Joint joint, const Input& start, const Input& base, const Input& wrench,
                  const Input& unstretched) {
  const Machine<double> machine = machine_of(design, joint);
  RestLoad load{vec6(rows(wrench, 1, 6, "wrench")), {}};
  std::copy_n(rows(unstretched, 1, 6, "unstretched"), 6, load.L_0);
  const States s(start, base);
  Pose<double> pose = s.platform->pose;
  const Rest end = settle(machine, s.base->pose, load, pose);
  Output found({12});
  double* out = found.data();
  write(out, pose);
  return nb::make_tuple(found.array(), end);
}

}  // namespace
}  // namespace flexapod

NB_MODULE(_core, m) {
  using namespace flexapod;
  m.doc() = "Flexapod's mechanics: compiled functions of a design and of motions.";
  bind_types(m);
  m.def("leg_rates", &leg_rates);
  m.def("leg_fit", &leg_fit);
  m.def("joint_angles", &joint_angles);
  m.def("leg_distance", &leg_distance);
  m.def("forward_kinematics", &forward_kinematics_);
  m.def("force_transformation", &force_transformation_);
  m.def("spring_matrix", &spring_matrix);
  m.attr("SPRING_LEGS") = spring_legs();
  m.def("equations_of_motion", &equations_of_motion);
  m.def("forward_dynamics", &forward_dynamics_);
  m.def("inverse_dynamics", &inverse_dynamics_);
  m.def("joint_reactions", &joint_reactions);
  m.def("energy", &energy_);
  m.def("natural_modes", &natural_modes_);
  m.def("inertia_parts", &inertia_parts);
  m.def("frequency_derivatives", &frequency_derivatives);
  m.def("tangent", &tangent_);
  m.def("settle", &settle_);
  bind_sweep(m);
  bind_designs(m);
  bind_simulation(m);
}
