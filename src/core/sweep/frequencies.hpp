// Many poses of one machine, packs of them at a time. The mechanics is that of the single pose, over packs.
#pragma once

#include "decomposition/singular_lanes.hpp"
#include "sweep/quantities.hpp"

namespace flexapod {

/// Angles of very many turns to within one.
template <int lanes> FLEXAPOD_COLD void wind_down(double (&angles)[lanes]) {
  for (double& a : angles)
    if (std::abs(a) > 1e6) a = std::atan2(std::sin(a), std::cos(a));
}

/// A task's poses from `first` on, in lanes; those beyond `count` are filled up with the last of them.
template <class T> void load_poses(const Task& task, size_t first, size_t count, double (&rows)[12][T::lanes]) {
  const sweep_task::Poses& poses = task.poses;
  const double *position = poses.position + first * poses.step, *rotation = poses.rotation + first * poses.turn_step;
  if (count == T::lanes) {
    for (int c = 0; c < 3; ++c) T::gather(position + c, poses.step).store(rows[c]);
    for (int c = 0; c < poses.turned; ++c) T::gather(rotation + c, poses.turn_step).store(rows[3 + c]);
  } else {
    for (size_t l = 0; l < T::lanes; ++l) {
      const size_t i = l < count ? l : count - 1;
      for (int c = 0; c < 3; ++c) rows[c][l] = position[i * poses.step + c];
      for (int c = 0; c < poses.turned; ++c) rows[3 + c][l] = rotation[i * poses.turn_step + c];
    }
  }
  if (poses.turned == 3)
    for (int c = 3; c < 6; ++c)
      if (any(abs(T::load(rows[c])) > 1e6)) [[unlikely]]
        wind_down(rows[c]);
}

template <class T> T singular_where(const mask_t<T>& bad, const T& fault) {
  return select(bad & (fault <= 0.0), T(sweep_task::singular), fault);
}

/// The condition of H.
template <class T> struct SweepCondition {
  const Task& task;
  const Rows rows;
  const ForceMap<T>& map;

  void begin(HalfBidiagonal<T>& half) const {
    Mat6<T> H = map.directions;
    flexapod::begin(H, half);
  }
  FLEXAPOD_FLAT T finish(SingularSquares<T>& squares) const {
    const auto bad = no_pose(map.fault);
    repair([this] { return map.directions; }, squares);
    const auto& share = squares.share;
    rows.put(task.cond_H_, unless(bad, sqrt(share[5] / share[0])));
    return singular_where(share[0] < 1e-26 * share[5], map.fault);
  }
};

/// Frequencies, for the joined packs of several parts.
template <class T, Swept kind> struct SweepModes {
  const SweptMachine& machine;
  const Task& task;
  const Rows rows;
  const MassAndForceMap<T, kind>& dynamics;

  FLEXAPOD_FLAT void begin(HalfBidiagonal<T>& half, T& others) const {
    auto matrix = B();
    if constexpr (kind == Swept::others) others = matrix.square_of_C();
    auto&& square = square_factor(matrix);
    flexapod::begin(square, half);
  }

  /// others: sum of the squares of the other springs alone.
  FLEXAPOD_FLAT T finish(SingularSquares<T>& squares, const T& others) const {
    repair([this] { return B(); }, squares);
    if constexpr (kind == Swept::others) replace_rounded(others, squares);
    const T fault = worse(!(squares.sum < 1e300), sweep_task::no_inertia, dynamics.fault);
    const auto bad = fault > T(sweep_task::singular);
    const bool all = task.quantities & Quantity::omega;
    for (int i = 0; i < (all ? 6 : 1); ++i) {
      const T omega = unless(bad, sqrt(squares.sum * squares.share[i]));
      if (all) rows.put(task.omega_, omega, i, 6);
      if (i == 0 && task.omega_1_ != nullptr) rows.put(task.omega_1_, omega);
    }
    return singular_where(squares.share[0] < 1e-26, fault);
  }

  T status() const {
    double code[T::lanes];
    dynamics.fault.store(code);
    for (int l = 0; l < rows.count; ++l) task.status_[rows.first + l] = static_cast<std::uint8_t>(code[l]);
    return dynamics.fault;
  }

 private:
  auto B() const { return dynamics.B(Cholesky<T>(dynamics.J.matrix())); }

  /// The square root of the other springs' sum is right to a rounding of its own size, which may be more than a rounding
  /// of omega_1 omega_6: there all columns are taken instead.
  void replace_rounded(const T& others, SingularSquares<T>& found) const {
    const T part = others / found.sum;
    const auto rounded = (part * part > 16.0 * found.share[0]) & (found.sum < 1e300);
    if (any(rounded)) [[unlikely]]
      by_all_columns(rounded, found);
  }
  FLEXAPOD_COLD void by_all_columns(const mask_t<T>& where, SingularSquares<T>& found) const {
    double numbers[12][T::lanes];
    load_poses<T>(task, rows.first, static_cast<size_t>(rows.count), numbers);
    const PosePack<T> at(machine, numbers, task.poses.turned);
    T exact[6];
    squares_by_rotations(all_columns(machine, at, dynamics.J, dynamics.along), exact);
    for (int i = 0; i < 6; ++i) found.share[i] = select(where, exact[i] / found.sum, found.share[i]);
  }
};

/// Poses of a task, in packs of T::parts parts: part by part where the work is wide and many numbers are held, joined
/// where it is one long chain. A batch of packs goes through one piece of the work after the other, so that the
/// processor keeps the piece's instructions at hand.
template <class T, Swept kind> class Sweep {
  using Part = typename T::Part;
  static constexpr int batch = 8;
  const Task& task;
  const SweptMachine machine;
  MassAndForceMap<Part, kind> part;
  MassAndForceMap<T, kind> joined[batch];
  HalfBidiagonal<T> half[batch];
  SingularSquares<T> squares[batch];
  T others[batch];
  double rows[12][Part::lanes];

 public:
  explicit Sweep(const Task& t) : task(t), machine(t) {
    part.set_constant(machine);
    for (auto& pack : joined) pack.set_constant(machine);
  }

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
        MassAndForceMap<T, kind>& dynamics = joined[done / T::lanes];
        const size_t left = count - done;
        const Rows rows{first + done, static_cast<int>(left < T::lanes ? left : T::lanes)};
        piece(SweepModes<T, kind>{machine, task, rows, dynamics}, dynamics.fault, static_cast<int>(done / T::lanes));
      }
    };
    const int packs = static_cast<int>((count + T::lanes - 1) / T::lanes);
    using Modes = SweepModes<T, kind>;
    if (asked & Quantity::cond_H) {
      const auto of = [](const Modes& modes) { return SweepCondition<T>{modes.task, modes.rows, modes.dynamics}; };
      each([&](const Modes& modes, T&, int i) { of(modes).begin(half[i]); });
      finish_all(Wanted::extremes, half, squares, packs);
      each([&](const Modes& modes, T& fault, int i) { fault = of(modes).finish(squares[i]); });
    }
    if (asked & modal) {
      each([&](const Modes& modes, T&, int i) { modes.begin(half[i], others[i]); });
      finish_all(asked & Quantity::omega ? Wanted::all : Wanted::lowest, half, squares, packs);
      each([&](const Modes& modes, T& fault, int i) { fault = modes.finish(squares[i], others[i]); });
    }
    each([](const Modes& modes, T&, int) { modes.status(); });
  }

  void one_part(size_t first, size_t count) {
    load_poses<Part>(task, first, count, rows);
    const PosePack<Part> at = pose_pack<Part>(machine, rows, task.poses.turned);
    const unsigned asked = task.quantities;
    if (asked & modal) assemble(at);
    else if (asked & Quantity::cond_H) part.set_legs(at);
    else part.fault = at.fault;
    const SweepQuantities<Part, kind> quantities{{machine, task, {first, static_cast<int>(count)}, at}};
    quantities.evaluate(part.fault);
  }
  FLEXAPOD_FLAT void assemble(const PosePack<Part>& at) { part.set(machine, at); }

  void join(MassAndForceMap<T, kind>& joined, int i) const {
    joined.fault.set_part(i, part.fault);
    if (!(task.quantities & (modal | Quantity::cond_H))) return;
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < spring_count; ++c) joined.directions[r][c].set_part(i, part.directions[r][c]);
    if (!(task.quantities & modal)) return;
    join(joined.J, part.J, i);
    if (!machine.constant())
      for (int j = 0; j < spring_count; ++j) joined.along.root[j].set_part(i, part.along.root[j]);
    if constexpr (kind == Swept::others) join(joined.others.sum, part.others.sum, i);
  }
  static void join(SpatialInertia<T>& to, const SpatialInertia<Part>& from, int i) {
    join(to.top, from.top, i), join(to.bottom, from.bottom, i);
    for (int r = 0; r < 3; ++r) {
      to.bottom_left.row[r].x.set_part(i, from.bottom_left.row[r].x);
      to.bottom_left.row[r].y.set_part(i, from.bottom_left.row[r].y);
      to.bottom_left.row[r].z.set_part(i, from.bottom_left.row[r].z);
    }
  }
  static void join(Sym3<T>& to, const Sym3<Part>& from, int i) {
    to.xx.set_part(i, from.xx), to.yy.set_part(i, from.yy), to.zz.set_part(i, from.zz);
    to.xy.set_part(i, from.xy), to.xz.set_part(i, from.xz), to.yz.set_part(i, from.yz);
  }
};

}  // namespace flexapod
