// How stiff a leg is along itself: its own spring, constant or by a law of its length, in series with the other springs
// that its force passes through.
#pragma once

#include "model/design.hpp"
#include "model/features.hpp"
#include "numbers/dual.hpp"

namespace flexapod {

/// A table of stiffness by length as monotone cubics between its nodes: slopes after F. N. Fritsch and R. E. Carlson
/// (SIAM J. Numer. Anal. 17, 1980) by the harmonic means of Fritsch and J. Butland (SIAM J. Sci. Stat. Comput. 5, 1984).
template <class T> struct TablePiece {
  T start, value, slope, square, cube;  // value + s (slope + s (square + s cube)), s from the start

  template <class U> U at(const U& L) const {
    const U s = L - start;
    return value + s * (slope + s * (square + s * cube));
  }
};

template <class T> struct StiffnessTable {
  int count = 0;
  TablePiece<T> piece[table_capacity - 1];
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

  /// The piece that holds a length; the first and the last go on beyond the table.
  template <class U> TablePiece<U> piece_at(const U& L) const {
    U start(piece[0].start), value(piece[0].value), slope(piece[0].slope), square(piece[0].square), cube(piece[0].cube);
    for (int j = 1; j < count - 1; ++j) {
      const TablePiece<T>& p = piece[j];
      const auto beyond = L > U(p.start);
      start = select(beyond, U(p.start), start), value = select(beyond, U(p.value), value);
      slope = select(beyond, U(p.slope), slope), square = select(beyond, U(p.square), square);
      cube = select(beyond, U(p.cube), cube);
    }
    return {start, value, slope, square, cube};
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
    const T k = features.law == Law::table ? table.piece_at(L).at(L) : formula(d, features, i, L);
    return select(room(d, features, i, L) > T(0.0), in_series(d, features, i, k),
                  T(std::numeric_limits<double>::quiet_NaN()));
  }

  /// Of a screw or of columns of oil alone, wherever that is a number.
  template <class T> T formula(const Design<D>& d, const Features& features, int i, const T& L) const {
    const LegSprings<D>& s = d.springs[i];
    if (features.law == Law::screw) return 1.0 / (1.0 / T(s.fixed) + (L - s.zero_length) / s.axial_rigidity);
    const T x = L - s.shortest, rest = T(s.stroke) - x;
    return s.bulk_modulus * (s.area_1 / (x + s.dead_1) + s.area_2 / (rest + s.dead_2));
  }
  /// A stiffness with the springs in series.
  template <class T> T in_series(const Design<D>& d, const Features& features, int i, const T& k) const {
    if (!features.series) return k;
    return k / (1.0 + k * d.springs[i].series_compliance);
  }
  /// How far a length is inside the law's range, m, and not negative where it leaves it by rounding only.
  template <class T> T room(const Design<D>& d, const Features& features, int i, const T& L) const {
    const LegSprings<D>& s = d.springs[i];
    const T slack = 1e-12 * L;
    if (features.law == Law::table) return min<T>(L - table.piece[0].start, table.end - L) + slack;
    if (features.law == Law::screw) return L - s.zero_length + slack;
    const T x = L - s.shortest;
    return min<T>(x, s.stroke - x) + slack;
  }
};

}  // namespace flexapod
