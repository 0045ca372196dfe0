// Sweeps over poses and over designs on several threads: what is asked for, and the arrays that come back.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "model/features.hpp"
#include "numbers/array.hpp"
#include "sweep/task.hpp"
#include "threads/parallel_for.hpp"

namespace flexapod {

/// An array of results: its name, what to ask for to get it, its place in a task, its columns.
struct SweepArray {
  const char* name;
  sweep_task::Quantity quantity;
  double* sweep_task::Task::* place;
  std::size_t columns;
};
inline constexpr SweepArray sweep_arrays[] = {
#define FLEXAPOD_SWEEP_ARRAY(name, quantity, columns) \
  {#name, sweep_task::quantity, &sweep_task::Task::name##_, columns},
    FLEXAPOD_SWEEP_ARRAYS(FLEXAPOD_SWEEP_ARRAY)};
/// The array of truth values: its name, and what to ask for.
inline constexpr std::pair<const char*, sweep_task::Quantity> within_limits{"within_limits", sweep_task::within_limits};

/// Limits that every pose keeps.
inline sweep_task::Limits no_limits() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  sweep_task::Limits limits{};
  for (auto& length : limits.length) length[0] = -infinity, length[1] = infinity;
  limits.universal_angle = limits.spherical_angle = infinity, limits.leg_distance = -infinity;
  limits.universal_moment = limits.spherical_moment = infinity;
  return limits;
}

/// Poses in rows of 6 (position; roll, pitch, yaw) or 12 (position; rotation matrix by rows).
inline sweep_task::Poses poses_in_rows(const double* rows, std::size_t width) {
  return {rows, rows + 3, width, width, static_cast<int>(width) - 3};
}

/// Results of a sweep: a row for each pose.
struct SweepRows {
  std::vector<std::pair<const char*, Array<double>>> numbers;
  std::unique_ptr<Array<bool>> within;  // null where not asked for
  Array<std::uint8_t> status;           // values of sweep_task::Status
};

/// Poses of `task`, n of them, on threads; the task's results are set here. A pose's result does not depend on its block.
inline SweepRows sweep(const sweep_task::Kernel& kernel, sweep_task::Task task, std::size_t n, int threads) {
  SweepRows found{{}, nullptr, Array<std::uint8_t>({n})};
  for (const SweepArray& array : sweep_arrays) {
    if (!(task.quantities & array.quantity)) continue;
    const std::vector<std::size_t> shape = array.columns == 1 ? std::vector{n} : std::vector{n, array.columns};
    found.numbers.emplace_back(array.name, Array<double>(shape));
    task.*array.place = found.numbers.back().second.data();
  }
  if (task.quantities & within_limits.second) found.within = std::make_unique<Array<bool>>(std::vector{n});
  task.within_limits_ = found.within ? found.within->data() : nullptr;
  task.status_ = found.status.data();
  in_blocks(n, 2048, threads, [&](std::size_t first, std::size_t last) { kernel.sweep(task, first, last); });
  return found;
}

/// Which springs any of n designs has; throws std::invalid_argument where their stiffness laws are of several kinds.
inline Features features_of(const double* designs, std::size_t n) {
  Features all;
  for (std::size_t i = 0; i < n; ++i) {
    const auto& design = *reinterpret_cast<const Design<double>*>(designs + i * design_size);
    const Features one = used_size(design) == plain_size ? Features() : Features(design);
    if (i > 0 && one.law != all.law) throw std::invalid_argument("designs must have stiffness laws of one kind");
    all = all | one;
  }
  return all;
}

/// Frequencies of n designs: (designs, poses, modes), or (designs, 1, modes) where each has a pose of its own.
inline Array<double> sweep_designs(const sweep_task::Kernel& kernel, sweep_task::DesignTask task, std::size_t n,
                                   int threads) {
  Array<double> omega({n, task.paired ? 1 : task.poses_count, static_cast<std::size_t>(task.modes)});
  task.omega = omega.data();
  const Features features = features_of(task.designs, n);
  task.law = features.law, task.series = features.series;
  task.joints = features.joints, task.suspension = features.suspension;
  in_blocks(n, 256, threads, [&](std::size_t first, std::size_t last) { kernel.sweep_designs(task, first, last); });
  return omega;
}

}  // namespace flexapod
