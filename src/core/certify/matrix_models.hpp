// K - t M as a matrix of models, in a frame in which it is the unit matrix at the centre of the box.
#pragma once

#include "certify/pose_models.hpp"
#include "certify/vertex_test.hpp"
#include "model/springs.hpp"

namespace flexapod {

/// Rows C_a = V_a^T / sqrt(|squares_a - t|) of the modes V_a of K V = squares M V, the row that is weakest first.
template <class Lane> using FrameRows = Lane[6][6];

/// Modes of a centre: ascending squares, V_a^T M V_b = 1 or 0.
template <class Lane> struct CentreModes {
  Lane square[6], V[6][6];

  /// K = F F^T.
  template <int m> CentreModes(const Mat6<Lane>& M, Mat6<Lane, m> F) {
    const Cholesky<Lane> L(M);
    L.forward_all(F);
    Mat6<Lane> U;
    for (int i = 0; i < 6; ++i) U[i][i] = Lane(1.0);
    orthogonalise_rows<6, m, Lane>(F.a, U.a);
    for (int i = 0; i < 6; ++i) {
      square[i] = row_square(F.a[i]);
      Vec6<Lane> u;
      for (int k = 0; k < 6; ++k) u[k] = U[i][k];
      u = L.backward(u);
      for (int k = 0; k < 6; ++k) V[i][k] = u[k];
    }
    for (int last = 5; last > 0; --last)
      for (int i = 0; i < last; ++i) order(i, i + 1);
  }

  /// Rows for K - t M, or with `above` for t M - K.
  void frame(const Lane& t, bool above, FrameRows<Lane>& C) const {
    for (int a = 0; a < 6; ++a) {
      const int from = above ? 5 - a : a;
      const Lane scale = rsqrt(above ? t - square[from] : square[from] - t);
      for (int k = 0; k < 6; ++k) C[a][k] = scale * V[from][k];
    }
  }

 private:
  void order(int i, int j) {
    const auto wrong = square[j] < square[i];
    const auto swap = [&](Lane& a, Lane& b) {
      const Lane x = select(wrong, b, a), y = select(wrong, a, b);
      a = x, b = y;
    };
    swap(square[i], square[j]);
    for (int k = 0; k < 6; ++k) swap(V[i][k], V[j][k]);
  }
};

/// sum w_r x_r, for constants, with the norms of the x_r known.
template <class T, class Lane>
FLEXAPOD_FLAT T combination(const Lane (&w)[6], const T* const (&x)[6], const Lane (&norm)[6]) {
  T sum;
  for (int k = 0; k < T::count; ++k) {
    Lane c = w[0] * x[0]->c[k];
    for (int r = 1; r < 6; ++r) c += w[r] * x[r]->c[k];
    sum.c[k] = c;
  }
  Lane radius(0.0), size(0.0);
  for (int r = 0; r < 6; ++r) radius += abs(w[r]) * x[r]->r, size += abs(w[r]) * norm[r];
  sum.r = (radius + rounding::unit * size) * rounding::up + rounding::least;
  return sum;
}

/// Adds sum_j k_j (C d_j)(C d_j)^T for the directions d_j of springs.
template <class T, class Lane, class Stiffness>
void add_springs(MatrixModel<T>& A, const FrameRows<Lane>& C, const SpringMatrix<T>& directions, double sign,
                 Stiffness&& stiffness) {
  for (int j = 0; j < spring_count; ++j) {
    const T* d[6];
    Lane norm[6];
    for (int r = 0; r < 6; ++r) d[r] = &directions[r][j], norm[r] = typename T::Norms(*d[r]).all;
    T x[6];
    for (int a = 0; a < 6; ++a) x[a] = combination(C[a], d, norm);
    const typename T::Norms norms[6] = {typename T::Norms(x[0]), typename T::Norms(x[1]), typename T::Norms(x[2]),
                                        typename T::Norms(x[3]), typename T::Norms(x[4]), typename T::Norms(x[5])};
    const Lane k(sign * stiffness(j));
    for (int a = 0; a < 6; ++a)
      for (int b = 0; b <= a; ++b) A.a[entry(a, b)].add_product(k, x[a], norms[a], x[b], norms[b]);
  }
}

/// Adds factor C M C^T.
template <class T, class Lane>
void add_matrix(MatrixModel<T>& A, const FrameRows<Lane>& C, const Mat6<T>& M, const Lane& factor) {
  Lane norm[6][6];
  for (int r = 0; r < 6; ++r)
    for (int s = 0; s < 6; ++s) norm[r][s] = typename T::Norms(M[r][s]).all;
  for (int a = 0; a < 6; ++a) {
    T y[6];
    const T* each[6];
    Lane size[6];
    for (int s = 0; s < 6; ++s) {
      const T* const column[6] = {&M[0][s], &M[1][s], &M[2][s], &M[3][s], &M[4][s], &M[5][s]};
      const Lane sizes[6] = {norm[0][s], norm[1][s], norm[2][s], norm[3][s], norm[4][s], norm[5][s]};
      y[s] = combination(C[a], column, sizes);
      each[s] = &y[s], size[s] = typename T::Norms(y[s]).all;
    }
    for (int b = 0; b <= a; ++b) A.a[entry(a, b)] += factor * combination(C[b], each, size);
  }
}

}  // namespace flexapod
