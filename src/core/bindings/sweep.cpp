// The sweep over poses as Python sees it.
#include "sweep/batch.hpp"

#include <nanobind/stl/pair.h>

#include "bindings/arrays.hpp"
#include "bindings/bind.hpp"
#include "bindings/unlocked.hpp"
#include "kernels/isa.hpp"

namespace flexapod {
namespace {

using sweep_task::Limits, sweep_task::Quantity;

Limits make_limits(const Input& neutral, const Input& leg_length, double universal_angle, double spherical_angle,
                   double leg_distance, double universal_moment, double spherical_moment) {
  Limits limits{};
  std::copy_n(rows(neutral, 2, 18, "neutral"), 36, &limits.neutral[0][0][0]);
  std::copy_n(rows(leg_length, 6, 2, "leg_length"), 12, &limits.length[0][0]);
  limits.universal_angle = universal_angle, limits.spherical_angle = spherical_angle;
  limits.leg_distance = leg_distance;
  limits.universal_moment = universal_moment, limits.spherical_moment = spherical_moment;
  return limits;
}

void bind_limits(nb::module_& m) {
  nb::class_<Limits>(m, "SweepLimits")
      .def("__init__", [](Limits* self) { new (self) Limits(no_limits()); })
      .def(
          "__init__",
          [](Limits* self, const Input& neutral, const Input& leg_length, double universal_angle,
             double spherical_angle, double leg_distance, double universal_moment, double spherical_moment) {
            new (self) Limits(make_limits(neutral, leg_length, universal_angle, spherical_angle, leg_distance,
                                          universal_moment, spherical_moment));
          },
          nb::kw_only(), "neutral"_a, "leg_length"_a, "universal_angle"_a, "spherical_angle"_a, "leg_distance"_a,
          "universal_moment"_a, "spherical_moment"_a)
      .def_ro("universal_angle", &Limits::universal_angle)
      .def_ro("spherical_angle", &Limits::spherical_angle)
      .def_ro("leg_distance", &Limits::leg_distance)
      .def_ro("universal_moment", &Limits::universal_moment)
      .def_ro("spherical_moment", &Limits::spherical_moment);
}

nb::dict sweep_of(const Input& design, Joint joint, const sweep_task::Poses& poses, size_t n, Quantity quantities,
                  const Limits& limits, int threads) {
  if (threads < 1) throw std::invalid_argument("threads is " + std::to_string(threads) + "; it must be >= 1");
  sweep_task::Task task{};
  task.design = rows(design, 1, design_size, "design"), task.joint = joint;
  task.poses = poses, task.quantities = quantities, task.limits = &limits;
  SweepRows found = [&] {
    const Unlocked unlocked;
    return sweep(kernels().sweep, task, n, threads);
  }();
  nb::dict result;
  for (auto& [name, array] : found.numbers) result[name] = numpy(std::move(array));
  if (found.within) result[within_limits.first] = numpy(std::move(*found.within));
  result["status"] = numpy(std::move(found.status));
  return result;
}

nb::dict sweep_rows(const Input& design, Joint joint, const Input& poses, Quantity quantities, const Limits& limits,
                    int threads) {
  if (poses.ndim() != 2 || (poses.shape(1) != 6 && poses.shape(1) != 12))
    throw std::invalid_argument("poses must have shape (n, 6) or (n, 12)");
  const sweep_task::Poses given = poses_in_rows(poses.data(), poses.shape(1));
  return sweep_of(design, joint, given, poses.shape(0), quantities, limits, threads);
}

/// Positions (n, 3) and rotations, (n, 4) or (n, 9).
nb::dict sweep_parts(const Input& design, Joint joint, const std::pair<Input, Input>& poses, Quantity quantities,
                     const Limits& limits, int threads) {
  const auto& [position, rotation] = poses;
  const size_t n = position.size() / 3;
  if (rotation.ndim() != 2 || (rotation.shape(1) != 4 && rotation.shape(1) != 9))
    throw std::invalid_argument("rotations must have shape (n, 4) or (n, 9)");
  const size_t width = rotation.shape(1);
  const sweep_task::Poses given{rows(position, n, 3, "positions"), rows(rotation, n, width, "rotations"), 3, width,
                                static_cast<int>(width)};
  return sweep_of(design, joint, given, n, quantities, limits, threads);
}

}  // namespace

void bind_sweep(nb::module_& m) {
  bind_limits(m);
  m.def("sweep", &sweep_rows);
  m.def("sweep", &sweep_parts);
  nb::dict asked;
  for (const SweepArray& array : sweep_arrays) asked[array.name] = array.quantity;
  asked[within_limits.first] = within_limits.second;
  m.attr("SWEEP_ARRAYS") = asked;
}

}  // namespace flexapod
