// A matrix of Taylor models on halves of its box, where the vertex test fails for the convex squares that it leaves out:
// the polynomial is halved, which costs far less than new models of half the box.
#pragma once

#include "certify/vertex_test.hpp"
#include "simd/isa_vector.hpp"

namespace flexapod {

/// A matrix of models of one lane.
template <int n> struct Piece {
  static constexpr int count = Monomials<n, 3>::count;
  double c[symmetric_size][count + 1];  // coefficients and radius
  int lane, depth;                      // of the box; how often halved

  Piece() {}  // not set: it is large
};

/// What becomes of a monomial c u_i^power ... where u_i = side + u/2: c times scale[0] of the monomial itself, and c side
/// times scale[1] of that divided by u_i, c times scale[2] of that divided twice, c side times scale[3] ... (side^2 is 1/4).
struct Halved {
  int from, power, monomial[4];
  double scale[4];
};
template <int n> struct HalvingTable {
  static constexpr int count = Piece<n>::count, moved = binomial(n + 2, 2);
  double scale[n][count] = {};  // scale[0] of all
  Halved each[n][moved] = {};   // those that hold u_i

  constexpr HalvingTable() {
    constexpr const auto& m = monomials<n, 3>;
    constexpr double half[4] = {1.0, 0.5, 0.25, 0.125};
    for (int i = 0; i < n; ++i)
      for (int k = 0, held = 0; k < count; ++k) {
        const int power = m.power[k][i];
        scale[i][k] = half[power];
        if (power == 0) continue;
        Halved& to = each[i][held++];
        to.from = k, to.power = power;
        for (int q = 0; q <= power; ++q) {
          to.monomial[q] = m.of_code[m.code[k] - q * m.code[m.at(i)]];
          to.scale[q] = binomial(power, q) * half[power - q] * (q > 1 ? 0.25 : 1.0);
        }
      }
  }
};
template <int n> inline constexpr HalvingTable<n> halving_table{};

template <class Lane, int n, class Rules> class HalvingTest {
  using T = Taylor<Lane, n, 3, Rules>;
  using Mask = mask_t<Lane>;
  static constexpr int deepest = 6;

 public:
  /// Sets positive[l] to whether A is positive definite in all of the box of lane l < lanes.
  void operator()(const MatrixModel<T>& A, int lanes, bool (&positive)[Lane::lanes]) {
    for (int l = 0; l < lanes; ++l) positive[l] = true;
    pieces.clear();
    int lane[Lane::lanes] = {}, depth[Lane::lanes] = {};
    for (int l = 0; l < lanes; ++l) lane[l] = l;
    take_up(A, test(A), lanes, lane, depth, positive);
    while (!pieces.empty()) {
      const int taken = gather(lane, depth, positive);
      if (taken > 0) take_up(gathered, test(gathered), taken, lane, depth, positive);
    }
  }

  /// The polynomials on the two halves of u_axis.
  static void halves(const double (&c)[Piece<n>::count], int axis, double* below, double* above) {
    constexpr const HalvingTable<n>& table = halving_table<n>;
    for (int k = 0; k < Piece<n>::count; ++k) below[k] = above[k] = c[k] * table.scale[axis][k];
    for (const Halved& by : table.each[axis])
      for (int q = 1; q <= by.power; ++q) {
        const double part = c[by.from] * by.scale[q], side = q % 2 ? 0.5 * part : part;
        above[by.monomial[q]] += side;
        below[by.monomial[q]] += q % 2 ? -side : side;
      }
  }

 private:
  VertexTest<Lane, n, Rules> test;
  MatrixModel<T> gathered{};  // lanes that nothing was put into hold what they held
  List<Piece<n>> pieces;

  /// Puts down the halves of what was not proved and may be on halves; gives up the boxes of what may not.
  void take_up(const MatrixModel<T>& A, const typename VertexTest<Lane, n, Rules>::Verdict& verdict, int taken,
               const int (&lane)[Lane::lanes], const int (&depth)[Lane::lanes], bool (&positive)[Lane::lanes]) {
    double proved[Lane::lanes], curable[Lane::lanes];
    select(verdict.positive, Lane(1.0), Lane(0.0)).store(proved);
    select(verdict.squares, Lane(1.0), Lane(0.0)).store(curable);
    for (int l = 0; l < taken; ++l) {
      if (proved[l] > 0 || !positive[lane[l]]) continue;
      if (!(curable[l] > 0) || depth[l] >= deepest) positive[lane[l]] = false;
      else put_halves(A, verdict, l, lane[l], depth[l] + 1);
    }
  }

  void put_halves(const MatrixModel<T>& A, const typename VertexTest<Lane, n, Rules>::Verdict& verdict, int l, int lane,
                  int depth) {
    int axis = 0;
    double most = -1.0;
    for (int i = 0; i < n; ++i) {
      const double halve = lane_of(verdict.halve[i], l);
      if (halve > most) most = halve, axis = i;
    }
    pieces.resize(pieces.size() + 2);
    Piece<n>&below = pieces[pieces.size() - 2], &above = pieces.back();
    below.lane = above.lane = lane, below.depth = above.depth = depth;
    for (int k = 0; k < symmetric_size; ++k) {
      double c[Piece<n>::count];
      for (int i = 0; i < Piece<n>::count; ++i) c[i] = lane_of(A.a[k].c[i], l);
      halves(c, axis, below.c[k], above.c[k]);
      below.c[k][Piece<n>::count] = above.c[k][Piece<n>::count] = lane_of(A.a[k].r, l);
    }
  }

  /// Takes pieces into the lanes; how many. Those of boxes that were given up are left out.
  int gather(int (&lane)[Lane::lanes], int (&depth)[Lane::lanes], const bool (&positive)[Lane::lanes]) {
    int taken = 0;
    while (taken < Lane::lanes && !pieces.empty()) {
      const Piece<n>& piece = pieces.back();
      if (positive[piece.lane]) {
        lane[taken] = piece.lane, depth[taken] = piece.depth;
        put(piece, taken++);
      }
      pieces.pop_back();
    }
    return taken;
  }
  void put(const Piece<n>& piece, int l) {
    for (int k = 0; k < symmetric_size; ++k) {
      for (int i = 0; i < Piece<n>::count; ++i) set_lane(gathered.a[k].c[i], l, piece.c[k][i]);
      set_lane(gathered.a[k].r, l, piece.c[k][Piece<n>::count]);
    }
  }
};

}  // namespace flexapod
