// Many designs at once: natural frequencies of a pack of machines, each lane another design, at poses they share or at
// one of their own. The mechanics is that of the single machine, over packs.
#pragma once

#include "decomposition/singular_lanes.hpp"
#include "model/modes.hpp"
#include "sweep/pose_pack.hpp"

namespace flexapod {

using sweep_task::DesignTask;

/// B = L^-1 F in the platform's axes; `legs`: lanes where every leg has a length within its stiffness law and lies across
/// its axis.
template <Swept kind, class T> auto scaled_springs(const Machine<T>& machine, const Pose<T>& pose, mask_t<T>& legs) {
  const Pose<T> base{-transposed(pose.R, pose.t), transpose(pose.R)};
  const Geometry<T> g(machine.design, Pose<T>(), base);
  SpatialInertia<T> J = platform_inertia(machine.design, Mat3<T>::identity());
  SpringMatrix<T> directions;
  T k[spring_count];
  legs = T(0.0) < T(1.0);
  for (int i = 0; i < 6; ++i) {
    const LegAxes<T> leg(g.S[i], g.k[i], machine.joint);
    add_leg_inertia(J, leg, machine.inertia[i], g.q_p[i]);
    set_spring_directions(directions, i, g.q_p[i], leg);
    k[i] = machine.stiffness(i, leg.L);
    legs = legs & (leg.cosecant < 1e7) & (leg.L > 0.0) & (k[i] >= 0.0);
  }
  const Cholesky<T> L(J.matrix());
  SpringMatrix<T> B = RootStiffness<T>(k).scaled(directions);
  L.forward_all(B);
  if constexpr (kind == Swept::along_legs) {
    return B;
  } else {
    const T zero(0.0);
    const Vec3<T> none(zero, zero, zero);
    const Sym3<T> nothing{zero, zero, zero, zero, zero, zero};
    SpatialInertia<T> K{nothing, {{none, none, none}}, nothing};
    add_other_stiffness(K, machine, g, Mat3<T>::identity(), base.R);
    Blocks<T> blocks{B, semidefinite_root(K.matrix())};
    L.forward_lower(blocks.C);
    return blocks;
  }
}

/// Designs first to last of a task, at all its poses or each at its own.
template <class T, Swept kind> class DesignSweep {
  const DesignTask& task;

 public:
  DesignSweep(const DesignTask& t, size_t first, size_t last) : task(t) {
    features_.law = task.law, features_.series = task.series;
    features_.joints = task.joints, features_.suspension = task.suspension;
    for (size_t i = first; i < last; i += T::lanes)
      pack(i, last - i < size_t{T::lanes} ? static_cast<int>(last - i) : T::lanes);
  }

 private:
  Features features_;

  /// `numbers` columns of rows first to first + count - 1 of a table that is `width` wide, the last row repeated to fill
  /// the lanes.
  static void read(const double* table, int width, int numbers, size_t first, int count, T* to) {
    double lanes[T::lanes];
    for (int c = 0; c < numbers; ++c) {
      for (int l = 0; l < T::lanes; ++l) lanes[l] = table[(first + (l < count ? l : count - 1)) * width + c];
      to[c] = T::load(lanes);
    }
  }

  void pack(size_t first, int count) const {
    Machine<T> machine(task.joint, features_);
    const bool plain = kind == Swept::along_legs && task.law == Law::constant && !task.series;
    read(task.designs, design_size, plain ? plain_size : design_size, first, count, &machine.design.gravity.x);
    machine.refresh();
    const size_t poses = task.paired ? 1 : task.poses_count;
    for (size_t k = 0; k < poses; ++k) {
      Pose<T> pose;
      static_assert(sizeof(pose) == 12 * sizeof(T));
      if (task.paired) {
        read(task.poses, 12, 12, first, count, &pose.t.x);
      } else {
        T* number = &pose.t.x;
        for (int c = 0; c < 12; ++c) number[c] = T(task.poses[12 * k + c]);
      }
      solve(machine, pose, [&](int l) { return (first + l) * poses + k; }, count);
    }
  }

  template <class Place> void solve(const Machine<T>& machine, const Pose<T>& pose, Place place, int count) const {
    mask_t<T> legs;
    HalfBidiagonal<T> half;
    SingularSquares<T> found;
    auto B = scaled_springs<kind>(machine, pose, legs);
    auto&& square = square_factor(B);
    begin(square, half);
    finish(task.modes == 6 ? Wanted::all : Wanted::lowest, half, found);
    repair([&] { return scaled_springs<kind>(machine, pose, legs); }, found);
    const auto bad = !(legs & (found.sum < 1e300));
    for (int i = 0; i < task.modes; ++i) {
      double x[T::lanes];
      select(bad, T(std::numeric_limits<double>::quiet_NaN()), sqrt(found.sum * found.share[i])).store(x);
      for (int l = 0; l < count; ++l) task.omega[place(l) * task.modes + i] = x[l];
    }
  }
};

}  // namespace flexapod
