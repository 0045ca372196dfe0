// Free vibration about a pose (Eq. 5), and what the derivatives of its frequencies are taken of.
#pragma once

#include "decomposition/svd_jacobi.hpp"
#include "model/displacement.hpp"
#include "model/springs.hpp"

namespace flexapod {

/// Ascending natural frequencies (rad/s) and mass-normalised shapes: columns are platform twists at the reference
/// point (translation, rotation vector; axes of the poses given) with shape^T J_p shape = E.
struct Modes {
  double omega[6];
  Mat6<double> shape;
};

/// Modes of B = L^-1 F with J_p = L L^T and K = F F^T.
template <int m> Modes modes_of(const Cholesky<double>& L, Mat6<double, m> B) {
  L.forward_all(B);
  const SingularValues values(B);
  Modes modes;
  for (int j = 0; j < 6; ++j) {
    modes.omega[j] = values.sigma[j];
    Vec6<double> u;
    for (int i = 0; i < 6; ++i) u[i] = values.u[i][j];
    u = L.backward(u);
    for (int i = 0; i < 6; ++i) modes.shape[i][j] = u[i];
  }
  return modes;
}

/// Eq. 5 by singular values: near a singular pose the eigenvalues of J_p^-1 K would lose half the digits of the lowest
/// frequency. R_p, R_b: of platform and base.
inline Modes natural_modes(const Machine<double>& machine, const Geometry<double>& g, const Mat3<double>& R_p,
                           const Mat3<double>& R_b) {
  const Cholesky<double> L(inertia(machine, g, R_p));
  if (machine.features.others()) return modes_of(L, spring_matrix(machine, g, R_p, R_b));
  return modes_of(L, leg_spring_matrix(machine, g));
}

/// v^T K v - lambda v^T J_p v for a mode's v and lambda = omega^2, of the springs along the legs with stiffnesses k. Its
/// derivative by anything, at fixed v and lambda, is that of lambda (for a mode that is not repeated), since
/// v^T J_p v = 1.
template <class T, class K, class U>
T rayleigh_residual(const K (&k)[spring_count], const Mat6<T>& J, const SpringMatrix<T>& directions,
                    const Vec6<U>& shape, const U& lambda) {
  T stretch[spring_count];
  spring_rates(directions, shape, stretch);
  return stiffness_product(k, stretch, stretch) - lambda * dot(shape, J * shape);
}

/// v^T K v of springs that do not lie along the legs.
template <class T, class U> T other_product(const Mat6<T>& K, const Vec6<U>& shape) { return dot(shape, K * shape); }
template <class T, class D>
Mat6<T> other_stiffness(const Machine<D>& machine, const Geometry<T>& g, const Mat3<T>& R_p, const Mat3<T>& R_b) {
  SpatialInertia<T> K{};
  add_other_stiffness(K, machine, g, R_p, R_b);
  return K.matrix();
}

/// The residuals of all modes, with all springs.
template <class T, class D>
Vec6<product_t<T, D>> rayleigh_residuals(const Machine<D>& machine, const Geometry<T>& g, const Mat3<T>& R_p,
                                         const Mat3<T>& R_b, const Modes& modes) {
  const Mat6<T> J = inertia(machine, g, R_p);
  const SpringMatrix<T> directions = spring_directions(g);
  Mat6<T> others;
  if (machine.features.others()) others = other_stiffness(machine, g, R_p, R_b);
  Vec6<T> residual;
  for (int m = 0; m < 6; ++m) {
    Vec6<double> v;
    for (int i = 0; i < 6; ++i) v[i] = modes.shape[i][m];
    const double lambda = modes.omega[m] * modes.omega[m];
    residual[m] =
        with_stiffness(machine, g, [&](const auto& k) { return rayleigh_residual(k, J, directions, v, lambda); });
    if (machine.features.others()) residual[m] += other_product(others, v);
  }
  return residual;
}

}  // namespace flexapod
