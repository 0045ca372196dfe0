// Whether a symmetric matrix of Taylor models is positive definite for all u in [-1, 1]^n.
//
// For a fixed vector v let f(u) = v^T A(u) v. Without its convex squares f is linear or concave in each u_i alone, so its
// least value is at a vertex, and convex squares are not negative. What is left to look at are 2^n matrices.
#pragma once

#include "certify/symmetric.hpp"
#include "certify/taylor.hpp"

namespace flexapod {

/// A(u), its lower triangle by rows.
template <class T> struct MatrixModel {
  T a[symmetric_size];
};

template <class Lane, int n, class Rules> class VertexTest {
  static constexpr int order = 3, vertices = 1 << n;
  static constexpr const Monomials<n, order>& m = monomials<n, order>;
  using T = Taylor<Lane, n, order, Rules>;
  using Mask = mask_t<Lane>;

 public:
  struct Verdict {
    Mask positive;  // proved
    Mask squares;   // not, but it might be if the convex squares were known better: on halves of the box
    Lane halve[n];  // how much of them there is along each u_i
  };

  FLEXAPOD_FLAT Verdict operator()(const MatrixModel<T>& A) {
    Verdict verdict;
    for (int k = 0; k < symmetric_size; ++k) reduce(A.a[k], k);
    Lane defect(0.0);
    auto sound = Lane(0.0) < Lane(1.0);
    for (int i = 0; i < n; ++i) split_square(A, i, sound, defect, verdict.halve[i]);
    error_diagonal(defect);
    for (int k = 0; k < symmetric_size; ++k) evaluate(A.a[k], k);
    look(verdict, sound);
    return verdict;
  }

 private:
  Lane constant[symmetric_size], linear[n][symmetric_size], error[symmetric_size];
  Symmetric6<Lane> convex[n];  // P_i of D_i = P_i - N_i
  Lane diagonal[6];
  Symmetric6<Lane> value[vertices];

  /// u_i^3 is 3/4 u_i up to 1/4, and u_i^2 u_j is 1/2 u_j up to 1/2.
  void reduce(const T& a, int k) {
    constant[k] = a.c[0];
    Lane cut(0.0), all = abs(a.c[0]);
    for (int i = 0; i < n; ++i) {
      const Lane cubic = a.c[m.at(i, i, i)];
      linear[i][k] = a.c[m.at(i)] + 0.75 * cubic;
      cut += 0.25 * abs(cubic);
      for (int j = 0; j < n; ++j) {
        if (j == i) continue;
        const Lane mixed = a.c[m.at(i, j, j)];
        linear[i][k] += 0.5 * mixed;
        cut += 0.5 * abs(mixed);
      }
    }
    for (int c = 1; c < T::count; ++c) all += abs(a.c[c]);
    error[k] = (a.r + cut + 64.0 * rounding::unit * all) * rounding::up;
  }

  /// D u^2 = P u^2 - N u^2 >= -N.
  void split_square(const MatrixModel<T>& A, int i, Mask& sound, Lane& defect, Lane& halve) {
    Symmetric6<Lane> D, N, check;
    Lane size(0.0);
    for (int k = 0; k < symmetric_size; ++k) D[k] = A.a[k].c[m.at(i, i)], size += abs(D[k]);
    negative_part(D, N);
    const Lane shift = 0x1p-32 * size + rounding::least;
    for (int k = 0; k < symmetric_size; ++k) convex[i][k] = check[k] = D[k] + N[k];
    for (int r = 0; r < 6; ++r) check[entry(r, r)] += shift;
    sound = sound & positive_definite(check);
    defect += 2.0 * shift;
    halve = Lane(0.0);
    for (int r = 0; r < 6; ++r) halve += convex[i][entry(r, r)];
    for (int k = 0; k < symmetric_size; ++k) {
      constant[k] -= N[k];
      if constexpr (!Rules::drop_squares) constant[k] += convex[i][k];
    }
  }

  /// sum_ab E_ab |v_a v_b| <= sum_a e_a v_a^2 with e_a = sum_b E_ab w_b / w_a for every positive w.
  void error_diagonal(const Lane& defect) {
    Lane w[6];
    for (Lane& each : w) each = Lane(1.0);
    for (int step = 0; step < 4; ++step) {
      Lane next[6], sum(0.0);
      multiply_error(w, next);
      for (const Lane& each : next) sum += each;
      for (int a = 0; a < 6; ++a) w[a] = next[a] / sum + 1e-9;
    }
    multiply_error(w, diagonal);
    for (int a = 0; a < 6; ++a) diagonal[a] = (diagonal[a] / w[a] + defect) * rounding::up;
  }
  /// The values of all that is multilinear at all vertices: bit i of a vertex's number says that u_i is 1.
  void evaluate(const T& a, int k) {
    Lane v[vertices];
    for (int subset = 0; subset < vertices; ++subset) v[subset] = Lane(0.0);
    v[0] = constant[k];
    for (int i = 0; i < n; ++i) {
      v[1 << i] = linear[i][k];
      for (int j = 0; j < i; ++j) {
        v[1 << i | 1 << j] = a.c[m.at(i, j)];
        for (int l = 0; l < j; ++l) v[1 << i | 1 << j | 1 << l] = a.c[m.at(i, j, l)];
      }
    }
    for (int bit = 1; bit < vertices; bit *= 2)
      for (int vertex = 0; vertex < vertices; ++vertex)
        if (!(vertex & bit)) {
          const Lane x = v[vertex], y = v[vertex | bit];
          v[vertex] = x - y, v[vertex | bit] = x + y;
        }
    for (int vertex = 0; vertex < vertices; ++vertex) value[vertex][k] = v[vertex];
  }

  /// The matrices at the vertices; where one is not positive definite, whether it would be with its convex squares.
  void look(Verdict& verdict, const Mask& sound) {
    verdict.positive = verdict.squares = sound;
    for (int vertex = 0; vertex < vertices; ++vertex) {
      Lane(&at)[symmetric_size] = value[vertex];
      for (int r = 0; r < 6; ++r) at[entry(r, r)] -= diagonal[r];
      const Mask positive = positive_definite(at);
      verdict.positive = verdict.positive & positive;
      if (!any(verdict.squares & !positive)) continue;
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < symmetric_size; ++k) at[k] += convex[i][k];
      verdict.squares = verdict.squares & (positive | positive_definite(at));
      if (!any(verdict.squares)) return;
    }
  }

  void multiply_error(const Lane (&w)[6], Lane (&to)[6]) const {
    for (int a = 0; a < 6; ++a) {
      to[a] = Lane(rounding::least);
      for (int b = 0; b < 6; ++b) to[a] += error[entry(a, b)] * w[b];
    }
  }
};

}  // namespace flexapod
