// The mechanics as Python sees it: functions of a design and of motions (n rows) that return arrays with n rows. Shapes
// and values are checked in Python; here only sizes are.
#include "bindings/arrays.hpp"
#include "bindings/bind.hpp"
#include "bindings/unlocked.hpp"
#include "kernels/isa.hpp"
#include "model/assemblies.hpp"
#include "threads/parallel_for.hpp"

namespace flexapod {
namespace {

/// A function of a machine and of states, for what is purely geometric and for what asks for the joint model.
template <auto function> auto of_geometry(const Input& design, const Input& platform, const Input& base) {
  return numpy(function(machine_of(design), states_of(platform, base)));
}
template <auto function> auto of_states(const Input& design, Joint joint, const Input& platform, const Input& base) {
  return numpy(function(machine_of(design, joint), states_of(platform, base)));
}

auto shared_joints_(const Input& joints) {
  return numpy(batch::shared_joints(reinterpret_cast<const EachLeg<Vec3<double>>&>(*rows(joints, 6, 3, "joints"))));
}

auto joint_angles_(const Input& design, const Input& platform, const Input& base, const Input& neutral) {
  const auto* directions = reinterpret_cast<const Vec3<double>(*)[6]>(rows(neutral, 2, 18, "neutral"));
  return numpy(batch::joint_angles(machine_of(design), states_of(platform, base), directions[0], directions[1]));
}

auto axial_stiffness_(const Input& design, const Input& lengths) {
  const size_t n = lengths.size() / 6;
  const auto* length = reinterpret_cast<batch::LegRows>(rows(lengths, n, 6, "lengths"));
  return numpy(batch::axial_stiffness(machine_of(design), n, length));
}

auto unstretched_lengths_(const Input& design, const Input& lengths, const Input& forces) {
  const size_t n = lengths.size() / 6;
  const auto* length = reinterpret_cast<batch::LegRows>(rows(lengths, n, 6, "lengths"));
  const auto* force = reinterpret_cast<batch::LegRows>(rows(forces, n, 6, "forces"));
  return numpy(batch::unstretched_lengths(machine_of(design), n, length, force));
}

auto forward_kinematics_(const Input& design, const Input& lengths, const Input& start) {
  const size_t n = lengths.size() / 6;
  const auto* wanted = reinterpret_cast<batch::LegRows>(rows(lengths, n, 6, "lengths"));
  return numpy(batch::forward_kinematics(machine_of(design), n, wanted, motions(start, n, "start")));
}

/// All assemblies for n sets of lengths: the set of each, poses, length errors; and for each set whether they are all.
nb::tuple all_assemblies(const assemblies::Search& search, const Input& lengths, int threads) {
  const size_t n = lengths.size() / 6;
  const auto* wanted = reinterpret_cast<batch::LegRows>(rows(lengths, n, 6, "lengths"));
  if (threads < 1) throw std::invalid_argument("threads is " + std::to_string(threads) + "; it must be >= 1");
  std::vector<assemblies::Found> found(n);
  {
    const Unlocked unlocked;
    in_blocks(n, 1, threads, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) found[i] = search.assemblies(wanted[i]);
    });
  }
  size_t total = 0;
  for (const auto& each : found) total += each.poses.size();
  Array<std::int64_t> sets({total});
  Array<double> poses({total, pose_size}), errors({total});
  Array<bool> complete({n});
  double *pose = poses.data(), *error = errors.data();
  std::int64_t* set = sets.data();
  for (size_t i = 0; i < n; ++i) {
    complete.data()[i] = found[i].complete;
    for (const FoundPose& each : found[i].poses)
      *set++ = std::int64_t(i), batch::write(pose, each.pose), *error++ = each.error;
  }
  return numpy(std::tuple{std::move(sets), std::move(poses), std::move(errors), std::move(complete)});
}

auto forward_dynamics_(const Input& design, Joint joint, const Input& platform, const Input& base,
                       const Input& leg_force, const Input& wrench) {
  const States s = states_of(platform, base);
  Array<double> acceleration({s.n, 6});
  kernels().simulation.forward_dynamics({rows(design, 1, design_size, "design"), joint, s.n, platform.data(),
                                         base.data(), rows(leg_force, s.n, 6, "leg_force"),
                                         rows(wrench, s.n, 6, "wrench"), acceleration.data()});
  return numpy(std::move(acceleration));
}

auto inverse_dynamics_(const Input& design, Joint joint, const Input& platform, const Input& base,
                       const Input& wrench) {
  const States s = states_of(platform, base);
  return numpy(batch::inverse_dynamics(machine_of(design, joint), s, sixes(wrench, s.n, "wrench")));
}

auto joint_reactions_(const Input& design, Joint joint, const Input& platform, const Input& base,
                      const Input& leg_force, double section) {
  const States s = states_of(platform, base);
  return numpy(batch::joint_reactions(machine_of(design, joint), s, sixes(leg_force, s.n, "leg_force"), section));
}

auto energy_(const Input& design, Joint joint, const Input& platform, const Input& base, const Input& unstretched) {
  const States s = states_of(platform, base);
  const auto* lengths = reinterpret_cast<batch::LegRows>(rows(unstretched, s.n, 6, "unstretched"));
  return numpy(batch::energy(machine_of(design, joint), s, lengths));
}

RestLoad rest_load(const Input& wrench, const Input& unstretched) {
  RestLoad load{*sixes(wrench, 1, "wrench"), {}};
  std::copy_n(rows(unstretched, 1, 6, "unstretched"), 6, load.L_0);
  return load;
}

auto settle_(const Input& design, Joint joint, const Input& start, const Input& base, const Input& wrench,
             const Input& unstretched) {
  return numpy(batch::settle(machine_of(design, joint), states_of(start, base), rest_load(wrench, unstretched)));
}

}  // namespace

void bind_mechanics(nb::module_& m) {
  m.def("leg_rates", &of_geometry<batch::leg_rates>);
  m.def("leg_fit", &of_geometry<batch::leg_fit>);
  m.def("joint_angles", &joint_angles_);
  m.def("leg_distances", &of_geometry<batch::leg_distances>);
  m.def("shared_joints", &shared_joints_);
  m.def("forward_kinematics", &forward_kinematics_);
  nb::class_<assemblies::Search>(m, "AssemblySearch")
      .def("__init__", [](assemblies::Search* self,
                          const Input& design) { new (self) assemblies::Search(machine_of(design).design); })
      .def_prop_ro("paths", &assemblies::Search::paths)
      .def("find", &all_assemblies);
  m.def("force_transformation", &of_geometry<batch::force_transformation>);
  m.def("spring_matrix", &of_states<batch::spring_matrix>);
  nb::list legs;
  for (int j = 0; j < all_springs; ++j) legs.append(spring_leg(j));
  m.attr("SPRING_LEGS") = nb::tuple(legs);  // the leg of each spring; those along the legs come first
  m.def("axial_stiffness", &axial_stiffness_);
  m.def("unstretched_lengths", &unstretched_lengths_);
  m.def("joint_moments", &of_states<batch::joint_moments>);
  m.def("equations_of_motion", &of_states<batch::equations_of_motion>);
  m.def("forward_dynamics", &forward_dynamics_);
  m.def("inverse_dynamics", &inverse_dynamics_);
  m.def("joint_reactions", &joint_reactions_);
  m.def("energy", &energy_);
  m.def("natural_modes", &of_states<batch::natural_modes>);
  m.def("inertia_parts", &of_states<batch::inertia_parts>);
  m.def("frequency_derivatives", &of_states<batch::frequency_derivatives>);
  m.def("settle", &settle_);
}

}  // namespace flexapod
