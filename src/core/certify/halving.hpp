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
};

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
    for (const double side : {-0.5, 0.5}) {
      pieces.emplace_back();
      Piece<n>& piece = pieces.back();
      piece.lane = lane, piece.depth = depth;
      for (int k = 0; k < symmetric_size; ++k) {
        double c[Piece<n>::count];
        for (int i = 0; i < Piece<n>::count; ++i) c[i] = lane_of(A.a[k].c[i], l);
        substitute(c, axis, side, piece.c[k]);
        piece.c[k][Piece<n>::count] = lane_of(A.a[k].r, l);
      }
    }
  }

  /// u_i = side + u/2: u^p gives binomial(p, q) side^(p - q) (u/2)^q.
  static void substitute(const double (&c)[Piece<n>::count], int axis, double side, double (&to)[Piece<n>::count + 1]) {
    constexpr const auto& m = monomials<n, 3>;
    for (int k = 0; k < Piece<n>::count; ++k) to[k] = 0.0;
    for (int k = 0; k < Piece<n>::count; ++k) {
      const int p = m.power[k][axis], unit = m.code[m.at(axis)];
      double factor = c[k];
      for (int q = p; q >= 0; --q) {
        const int at = m.of_code[m.code[k] - (p - q) * unit];
        double half = 1.0;
        for (int i = 0; i < q; ++i) half *= 0.5;
        to[at] += factor * half * binomial(p, q);
        factor *= side;
      }
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
