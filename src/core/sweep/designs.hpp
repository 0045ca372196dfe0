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

/// Designs of a task, in packs, at all its poses or each at its own. A batch of packs and poses goes through one piece of
/// the work after the other, as in a sweep over poses.
template <class T, Swept kind> class DesignSweep {
  static constexpr int batch = 8;
  struct Item {
    size_t first, pose;  // the pack's first design
    int count;           // designs in it
    mask_t<T> legs;
  };
  const DesignTask& task;
  Features features_;
  Item items_[batch];
  HalfBidiagonal<T> half_[batch];
  SingularSquares<T> squares_[batch];
  int waiting_ = 0;

 public:
  explicit DesignSweep(const DesignTask& t) : task(t) {
    features_.law = task.law, features_.series = task.series;
    features_.joints = task.joints, features_.suspension = task.suspension;
  }

  void run(size_t first, size_t last) {
    for (size_t i = first; i < last; i += T::lanes) {
      const int count = last - i < size_t{T::lanes} ? static_cast<int>(last - i) : T::lanes;
      const Machine<T> machine = machines(i, count);
      for (size_t k = 0; k < poses(); ++k) begin_one(machine, {i, k, count, {}});
    }
    finish();
  }

 private:
  size_t poses() const { return task.paired ? 1 : task.poses_count; }

  /// `numbers` columns of rows first to first + count - 1 of a table that is `width` wide, the last row repeated to fill
  /// the lanes.
  static void read(const double* table, int width, int numbers, size_t first, int count, T* to) {
    double lanes[T::lanes];
    for (int c = 0; c < numbers; ++c) {
      for (int l = 0; l < T::lanes; ++l) lanes[l] = table[(first + (l < count ? l : count - 1)) * width + c];
      to[c] = T::load(lanes);
    }
  }
  Machine<T> machines(size_t first, int count) const {
    Machine<T> machine(task.joint, features_);
    const bool plain = kind == Swept::along_legs && task.law == Law::constant && !task.series;
    read(task.designs, design_size, plain ? plain_size : design_size, first, count, &machine.design.gravity.x);
    machine.refresh();
    return machine;
  }
  Pose<T> pose_of(const Item& item) const {
    Pose<T> pose;
    static_assert(sizeof(pose) == 12 * sizeof(T));
    T* number = &pose.t.x;
    if (task.paired) read(task.poses, 12, 12, item.first, item.count, number);
    else
      for (int c = 0; c < 12; ++c) number[c] = T(task.poses[12 * item.pose + c]);
    return pose;
  }

  void begin_one(const Machine<T>& machine, Item item) {
    auto B = scaled_springs<kind>(machine, pose_of(item), item.legs);
    auto&& square = square_factor(B);
    begin(square, half_[waiting_]);
    items_[waiting_++] = item;
    if (waiting_ == batch) finish();
  }

  void finish() {
    finish_all(task.modes == 6 ? Wanted::all : Wanted::lowest, half_, squares_, waiting_);
    for (int i = 0; i < waiting_; ++i) write(items_[i], squares_[i]);
    waiting_ = 0;
  }
  void write(Item& item, SingularSquares<T>& found) const {
    repair([&] { return scaled_springs<kind>(machines(item.first, item.count), pose_of(item), item.legs); }, found);
    const auto bad = !(item.legs & (found.sum < 1e300));
    for (int i = 0; i < task.modes; ++i) {
      double x[T::lanes];
      select(bad, T(std::numeric_limits<double>::quiet_NaN()), sqrt(found.sum * found.share[i])).store(x);
      for (int l = 0; l < item.count; ++l) task.omega[((item.first + l) * poses() + item.pose) * task.modes + i] = x[l];
    }
  }
};

}  // namespace flexapod
