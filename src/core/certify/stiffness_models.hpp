// The stiffness of legs by a law of their length, over boxes.
#pragma once

#include "certify/elementary.hpp"
#include "model/machine.hpp"

namespace flexapod {

/// The ends of what a model says.
template <class T> struct Reach {
  typename T::Number low, high;

  explicit Reach(const T& a) {
    const auto size = a.variation() + rounding::unit * abs(a.c[0]);
    low = a.c[0] - size, high = a.c[0] + size;
  }
};

/// A piece's polynomial in s = L - node, and a bound of its absolute terms for |s| <= reach.
template <class Lane> struct ShiftedPiece {
  Lane value, slope, square, cube, size;

  ShiftedPiece(const TablePiece<Lane>& p, const Lane& node, const Lane& reach) {
    const Lane d = node - p.start, far = abs(d) + reach;
    value = p.value + d * (p.slope + d * (p.square + d * p.cube));
    slope = p.slope + d * (2.0 * p.square + d * (3.0 * p.cube));
    square = p.square + 3.0 * d * p.cube;
    cube = p.cube;
    size = abs(p.value) + far * (abs(p.slope) + far * (abs(p.square) + far * abs(p.cube)));
  }
};

/// How far two pieces are from one another within `reach` of a node, at most.
template <class Lane>
Lane apart_at(const TablePiece<Lane>& a, const TablePiece<Lane>& b, const Lane& node, const Lane& reach) {
  const ShiftedPiece<Lane> p(a, node, reach), q(b, node, reach);
  const Lane most =
      abs(p.value - q.value) +
      reach * (abs(p.slope - q.slope) + reach * (abs(p.square - q.square) + reach * abs(p.cube - q.cube)));
  return (most + rounding::unit * (p.size + q.size)) * rounding::up;
}

/// By a table: the cubic of the piece that holds the centre, with a radius for the others that the box reaches into. They
/// are compared about the node where the box enters them; at that next to the piece, values and slopes are the same.
template <class T> T table_stiffness(const StiffnessTable<double>& table, const T& L) {
  using Lane = typename T::Number;
  const TablePiece<Lane> here = table.piece_at(L.c[0]);
  const Reach<T> ends(L);
  const Lane none(0.0);
  Lane away = none;
  for (int j = 0; j < table.count - 1; ++j) {
    const TablePiece<double>& p = table.piece[j];
    const TablePiece<Lane> other{Lane(p.start), Lane(p.value), Lane(p.slope), Lane(p.square), Lane(p.cube)};
    const Lane stop(j + 2 < table.count ? table.piece[j + 1].start : table.end);
    const auto above = other.start > here.start, below = other.start < here.start;
    const Lane node = select(above, other.start, stop);
    const Lane reach = select(above, ends.high - node, node - ends.low) * rounding::up;
    const auto entered = (above | below) & (reach > none);
    if (any(entered)) away = select(entered, max(away, apart_at(here, other, node, reach)), away);
  }
  T k = here.at(L);
  if constexpr (T::Rule::other_pieces) k.r = (k.r + away) * rounding::up;
  return k;
}

/// The stiffness of leg i of length L, where the design has a law. Without a bound where the box leaves the law's range;
/// `outside` (1 or 0) says where the centre is beyond it. Where `limited`, lengths beyond it do not count.
template <class T>
T leg_stiffness(const Machine<double>& machine, int i, const T& L, bool limited, typename T::Number& outside) {
  using Lane = typename T::Number;
  const Design<double>& d = machine.design;
  const Features& features = machine.features;
  T k = features.law == Law::table ? table_stiffness(machine.axial.table, L) : machine.axial.formula(d, features, i, L);
  k = machine.axial.in_series(d, features, i, k);
  const auto room = [&](const Lane& length) { return machine.axial.room(d, features, i, length); };
  outside = select(room(L.c[0]) > 0.0, Lane(0.0), Lane(1.0));
  const Reach<T> ends(L);
  const Lane least = min(room(ends.low), room(ends.high));
  if (!limited) k.r = select(least > 0.0, k.r, Lane(std::numeric_limits<double>::infinity()));
  return k;
}

}  // namespace flexapod
