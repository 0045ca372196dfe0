// How stiff a leg is along itself: its own spring, constant or by a law of its length, in series with the other springs
// that its force passes through.
#pragma once

#include "model/design.hpp"
#include "model/features.hpp"
#include "numbers/dual.hpp"

namespace flexapod {

/// A table of stiffness by length as monotone cubics between its nodes: slopes after F. N. Fritsch and R. E. Carlson
/// (SIAM J. Numer. Anal. 17, 1980) by the harmonic means of Fritsch and J. Butland (SIAM J. Sci. Stat. Comput. 5, 1984).
template <class T> struct StiffnessTable {
  int count = 0;
  struct Piece {
    T start, value, slope, square, cube;  // value + s (slope + s (square + s cube)), s from the start
  } piece[table_capacity - 1];
  T end;

  void set(const Design<T>& d) {
    count = whole(d.table_count);
    const T *x = d.table_lengths.a, *y = d.table_stiffnesses.a;
    T width[table_capacity], rise[table_capacity], slope[table_capacity];
    for (int j = 0; j < count - 1; ++j) width[j] = x[j + 1] - x[j], rise[j] = (y[j + 1] - y[j]) / width[j];
    slope[0] = count > 2 ? end_slope(width[0], width[1], rise[0], rise[1]) : rise[0];
    slope[count - 1] =
        count > 2 ? end_slope(width[count - 2], width[count - 3], rise[count - 2], rise[count - 3]) : rise[0];
    for (int j = 1; j < count - 1; ++j) slope[j] = inner_slope(width[j - 1], width[j], rise[j - 1], rise[j]);
    for (int j = 0; j < count - 1; ++j)
      piece[j] = {x[j], y[j], slope[j], (3.0 * rise[j] - 2.0 * slope[j] - slope[j + 1]) / width[j],
                  (slope[j] + slope[j + 1] - 2.0 * rise[j]) / (width[j] * width[j])};
    end = x[count - 1];
  }

  template <class U> U at(const U& L) const {
    U start(piece[0].start), value(piece[0].value), slope(piece[0].slope), square(piece[0].square), cube(piece[0].cube);
    for (int j = 1; j < count - 1; ++j) {
      const Piece& p = piece[j];
      const auto beyond = L > U(p.start);
      start = select(beyond, U(p.start), start), value = select(beyond, U(p.value), value);
      slope = select(beyond, U(p.slope), slope), square = select(beyond, U(p.square), square);
      cube = select(beyond, U(p.cube), cube);
    }
    const U s = L - start;
    return value + s * (slope + s * (square + s * cube));
  }

 private:
  static T inner_slope(const T& h0, const T& h1, const T& r0, const T& r1) {
    const T w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
    return select(r0 * r1 > T(0.0), (w0 + w1) * (r0 * r1) / (w0 * r1 + w1 * r0), T(0.0));
  }
  static T end_slope(const T& h0, const T& h1, const T& r0, const T& r1) {
    const T slope = ((2.0 * h0 + h1) * r0 - h0 * r1) / (h0 + h1), steepest = 3.0 * r0;
    const auto overshoots = (r0 * r1 < T(0.0)) & (abs(slope) > abs(steepest));
    return select(slope * r0 > T(0.0), select(overshoots, steepest, slope), T(0.0));
  }
};

/// The axial stiffness of six legs.
template <class D> struct AxialStiffness {
  D constant[6];            // where there is no law: with the springs in series
  StiffnessTable<D> table;  // where the law is a table

  void set(const Design<D>& d, const Features& features) {
    if (features.law == Law::table) table.set(d);
    if (features.law != Law::constant) return;
    for (int i = 0; i < 6; ++i) {
      const D& k = d.leg[i].stiffness;
      constant[i] = features.series ? k / (1.0 + k * d.springs[i].series_compliance) : k;
    }
  }

  /// By the law of the design at a length; NaN outside the law's range but for rounding.
  template <class T> T at(const Design<D>& d, const Features& features, int i, const T& L) const {
    const LegSprings<D>& s = d.springs[i];
    const T slack = 1e-12 * L;
    const auto k_of = [&](const auto& inside, const T& k) {
      return select(inside, features.series ? k / (1.0 + k * s.series_compliance) : k,
                    T(std::numeric_limits<double>::quiet_NaN()));
    };
    if (features.law == Law::screw) {
      const T longer = L - s.zero_length, compliance = 1.0 / T(s.fixed) + longer / s.axial_rigidity;
      return k_of((longer + slack > T(0.0)) & (compliance > T(0.0)), 1.0 / compliance);
    }
    if (features.law == Law::hydraulic) {
      const T x = L - s.shortest, rest = T(s.stroke) - x;
      const T k = s.bulk_modulus * (s.area_1 / (x + s.dead_1) + s.area_2 / (rest + s.dead_2));
      return k_of((x + slack > T(0.0)) & (rest + slack > T(0.0)), k);
    }
    return k_of((L + slack > T(table.piece[0].start)) & (L < T(table.end) + slack), table.at(L));
  }
};

}  // namespace flexapod
