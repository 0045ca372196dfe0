// Many poses of one machine, packs of them at a time. The mechanics is that of the single pose, over packs.
#pragma once

#include "decomposition/singular_lanes.hpp"
#include "sweep/quantities.hpp"

namespace flexapod {

/// Frequencies and the condition of H, for the joined packs of several parts.
template <class T> struct SweepModes {
  const SweptMachine& machine;
  const Task& task;
  const Rows rows;
  const MassAndForceMap<T>& dynamics;

  template <bool all> FLEXAPOD_FLAT T frequencies() const {
    const auto B = [this] { return dynamics.B(machine, Cholesky<T>(dynamics.J.matrix())); };
    const auto squares = singular_squares<all ? Wanted::all : Wanted::lowest, T>(B);
    const T fault = worse(!(squares.sum < 1e300), sweep_task::no_inertia, dynamics.fault);
    const auto bad = fault > T(sweep_task::singular);
    for (int i = 0; i < (all ? 6 : 1); ++i) {
      const T omega = unless(bad, sqrt(squares.sum * squares.share[i]));
      if (all) rows.put(task.omega_, omega, i, 6);
      if (i == 0 && task.omega_1_ != nullptr) rows.put(task.omega_1_, omega);
    }
    return singular(squares.share[0] < 1e-26, fault);
  }

  FLEXAPOD_FLAT T condition() const {
    const auto bad = no_pose(dynamics.fault);
    const auto [share, sum] = singular_squares<Wanted::extremes, T>([this] { return dynamics.H(); });
    rows.put(task.cond_H_, unless(bad, sqrt(share[5] / share[0])));
    return singular(share[0] < 1e-26 * share[5], dynamics.fault);
  }

  T status() const {
    double code[T::lanes];
    dynamics.fault.store(code);
    for (int l = 0; l < rows.count; ++l) task.status_[rows.first + l] = static_cast<std::uint8_t>(code[l]);
    return dynamics.fault;
  }

 private:
  static T singular(const mask_t<T>& bad, const T& fault) {
    return select(bad & (fault <= 0.0), T(sweep_task::singular), fault);
  }
};

/// Poses of a task, in packs of T::parts parts: part by part where the work is wide and many numbers are held, joined
/// where it is one long chain. A batch of packs goes through one piece of the work after the other, so that the
/// processor keeps the piece's instructions at hand.
template <class T> class Sweep {
  using Part = typename T::Part;
  static constexpr int batch = 8;
  const Task& task;
  const SweptMachine machine;
  MassAndForceMap<Part> part;
  MassAndForceMap<T> joined[batch];
  double rows[12][Part::lanes];

 public:
  explicit Sweep(const Task& t) : task(t), machine(t) {}

  void run(size_t first, size_t last) {
    constexpr size_t size = size_t{batch} * T::lanes;
    for (size_t i = first; i < last; i += size) work_through(i, last - i < size ? last - i : size);
  }

 private:
  static constexpr unsigned modal = Quantity::omega_1 | Quantity::omega;

  void work_through(size_t first, size_t count) {
    for (size_t done = 0; done < count; done += Part::lanes) {
      one_part(first + done, count - done < Part::lanes ? count - done : Part::lanes);
      join(joined[done / T::lanes], static_cast<int>(done / Part::lanes % T::parts));
    }
    for (size_t done = 0; done < count; done += T::lanes) {  // what is left of the last pack: its first part again
      const size_t parts = (count - done + Part::lanes - 1) / Part::lanes;
      for (size_t i = parts; i < size_t{T::parts}; ++i) join(joined[done / T::lanes], static_cast<int>(i));
    }
    const unsigned asked = task.quantities;
    const auto each = [&](auto&& piece) {
      for (size_t done = 0; done < count; done += T::lanes) {
        MassAndForceMap<T>& dynamics = joined[done / T::lanes];
        const size_t left = count - done;
        const Rows rows{first + done, static_cast<int>(left < T::lanes ? left : T::lanes)};
        dynamics.fault = piece(SweepModes<T>{machine, task, rows, dynamics});
      }
    };
    if (asked & Quantity::cond_H) each([](const SweepModes<T>& modes) { return modes.condition(); });
    if (asked & Quantity::omega) each([](const SweepModes<T>& modes) { return modes.template frequencies<true>(); });
    else if (asked & Quantity::omega_1)
      each([](const SweepModes<T>& modes) { return modes.template frequencies<false>(); });
    each([](const SweepModes<T>& modes) { return modes.status(); });
  }

  void one_part(size_t first, size_t count) {
    load(first, count);
    const PosePack<Part> at = pose_pack();
    const unsigned asked = task.quantities;
    if (asked & modal) assemble(at);
    else if (asked & Quantity::cond_H) part.set_legs(machine, at);
    else part.fault = at.fault;
    const SweepQuantities<Part> quantities{machine, task, {first, static_cast<int>(count)}, at};
    quantities.evaluate(part.fault);
  }
  FLEXAPOD_FLAT PosePack<Part> pose_pack() const { return PosePack<Part>(machine, rows, task.width); }
  FLEXAPOD_FLAT void assemble(const PosePack<Part>& at) { part.set(machine, at); }

  /// A short last part is filled up with its last pose.
  void load(size_t first, size_t count) {
    for (int l = 0; l < Part::lanes; ++l) {
      const double* pose = task.poses + (first + (static_cast<size_t>(l) < count ? l : count - 1)) * task.width;
      for (int c = 0; c < task.width; ++c) rows[c][l] = pose[c];
    }
    if (task.width == 6)
      for (int c = 3; c < 6; ++c)
        if (any(abs(Part::load(rows[c])) > 1e6)) [[unlikely]]
          wind_down(rows[c]);
  }
  /// Angles of very many turns to within one.
  static FLEXAPOD_COLD void wind_down(double (&angles)[Part::lanes]) {
    for (double& a : angles)
      if (std::abs(a) > 1e6) a = std::atan2(std::sin(a), std::cos(a));
  }
  void join(MassAndForceMap<T>& joined, int i) const {
    joined.fault.set_part(i, part.fault);
    if (!(task.quantities & (modal | Quantity::cond_H))) return;
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < spring_count; ++c) joined.directions[r][c].set_part(i, part.directions[r][c]);
    if (!(task.quantities & modal)) return;
    join(joined.J.top, part.J.top, i), join(joined.J.bottom, part.J.bottom, i);
    for (int r = 0; r < 3; ++r) {
      joined.J.bottom_left.row[r].x.set_part(i, part.J.bottom_left.row[r].x);
      joined.J.bottom_left.row[r].y.set_part(i, part.J.bottom_left.row[r].y);
      joined.J.bottom_left.row[r].z.set_part(i, part.J.bottom_left.row[r].z);
    }
  }
  static void join(Sym3<T>& to, const Sym3<Part>& from, int i) {
    to.xx.set_part(i, from.xx), to.yy.set_part(i, from.yy), to.zz.set_part(i, from.zz);
    to.xy.set_part(i, from.xy), to.xz.set_part(i, from.xz), to.yz.set_part(i, from.yz);
  }
};

}  // namespace flexapod
