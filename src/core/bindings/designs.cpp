// Searches over designs as Python sees them.
#include "bindings/arrays.hpp"
#include "bindings/bind.hpp"
#include "bindings/unlocked.hpp"
#include "kernels/isa.hpp"
#include "model/design_directions.hpp"
#include "sweep/batch.hpp"

namespace flexapod {
namespace {

/// (designs, poses, modes) or, paired, (designs, 1, modes).
nb::object sweep_designs_(const Input& designs, Joint joint, const Input& poses, bool paired, int modes, int threads) {
  if (threads < 1) throw std::invalid_argument("threads is " + std::to_string(threads) + "; it must be >= 1");
  if (modes != 1 && modes != 6) throw std::invalid_argument("modes must be 1 or 6");
  const size_t n = designs.size() / design_size, k = poses.size() / pose_size;
  sweep_task::DesignTask task{};
  task.designs = rows(designs, n, design_size, "designs"), task.joint = joint;
  task.poses = rows(poses, paired ? n : k, pose_size, "poses"), task.poses_count = k;
  task.paired = paired, task.modes = modes;
  Array<double> omega = [&] {
    const Unlocked unlocked;
    return sweep_designs(kernels().sweep, task, n, threads);
  }();
  return numpy(std::move(omega));
}

void make_directions(DesignDirections* self, const Input& design, Joint joint, const Input& platform,
                     const Input& directions, const Input& displacements, const Input& home,
                     const Input& home_displacements) {
  const size_t n = platform.size() / motion_size, m = directions.size() / design_size;
  const size_t homes = home.size() == 0 ? 0 : 1;
  rows(directions, m, design_size, "directions"), rows(displacements, n * m, 6, "displacements");
  rows(home_displacements, homes * m, 6, "home_displacements");
  new (self) DesignDirections(machine_of(design, joint), {motions(platform, n, "platform"), n}, span(directions),
                              span(displacements), {motions(home, homes, "home"), homes}, span(home_displacements));
}

nb::tuple arrays(ValueGradient&& found) {
  return nb::make_tuple(numpy(std::move(found.value)), numpy(std::move(found.derivative)));
}

}  // namespace

void bind_designs(nb::module_& m) {
  m.def("sweep_designs", &sweep_designs_);
  nb::class_<DesignDirections>(m, "DesignDirections")
      .def("__init__", &make_directions, nb::kw_only(), "design"_a, "joint"_a, "platform"_a, "directions"_a,
           "displacements"_a, "home"_a, "home_displacements"_a)
      .def("frequencies",
           [](const DesignDirections& self) {
             FrequencyGradient found = self.frequencies();
             return nb::make_tuple(numpy(std::move(found.omega)), numpy(std::move(found.rayleigh)));
           })
      .def("force_transformation", [](const DesignDirections& self) { return arrays(self.force_transformation()); })
      .def("stiffness", [](const DesignDirections& self) { return arrays(self.stiffness()); })
      .def("held_wrench", [](const DesignDirections& self) { return arrays(self.held_wrench()); })
      .def("legs", [](const DesignDirections& self) {
        LegGradient found = self.legs();
        return nb::make_tuple(arrays(std::move(found.length)), arrays(std::move(found.distance)),
                              arrays(std::move(found.joint_cosine)), arrays(std::move(found.joint_moment)));
      });
}

}  // namespace flexapod
