// Free vibration about a pose (Eq. 5), and how the frequencies depend on the pose and on the design.
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

/// Eq. 5 as singular values of B = L^-1 F with J_p = L L^T and K = F F^T: near a singular pose the eigenvalues of
/// J_p^-1 K would lose half the digits of the lowest frequency.
inline Modes natural_modes(const Machine<double>& machine, const Geometry<double>& g, const Mat3<double>& R) {
  const Cholesky<double> L(inertia(machine, g, R));
  SpringMatrix<double> B = RootStiffness<double>(machine.design).scaled(spring_directions(g, machine.joint));
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

/// v^T K v - lambda v^T J_p v for a mode's v and lambda = omega^2. Its derivative by anything, at fixed v and
/// lambda, is that of lambda (for a mode that is not repeated), since v^T J_p v = 1.
template <class T, class D, class U>
T rayleigh_residual(const Machine<D>& machine, const Mat6<T>& J, const SpringMatrix<T>& directions,
                    const Vec6<U>& shape, const U& lambda) {
  Vec6<T> v;
  for (int i = 0; i < 6; ++i) v[i] = T(shape[i]);
  T stretch[spring_count];
  spring_rates(directions, v, stretch);
  return stiffness_product(machine.design, stretch, stretch) - T(lambda) * dot(v, J * v);
}

/// The residuals of all modes.
template <class T, class D>
Vec6<product_t<T, D>> rayleigh_residuals(const Machine<D>& machine, const Geometry<T>& g, const Mat3<T>& R,
                                         const Modes& modes) {
  const Mat6<T> J = inertia(machine, g, R);
  const SpringMatrix<T> directions = spring_directions(g, machine.joint);
  Vec6<T> residual;
  for (int m = 0; m < 6; ++m) {
    Vec6<double> v;
    for (int i = 0; i < 6; ++i) v[i] = modes.shape[i][m];
    residual[m] = rayleigh_residual(machine, J, directions, v, modes.omega[m] * modes.omega[m]);
  }
  return residual;
}

/// Derivatives of the six omega^2 by the numbers of the design, exact: row m, one column a number.
inline void design_derivatives(const Design<double>& design, Joint joint, const Pose<double>& platform,
                               const Pose<double>& base, const Modes& modes, double (*out)[design_size]) {
  constexpr int lanes = 8;
  using D = Dual<lanes>;
  const double* value = &design.gravity.x;
  const int used = used_size(design);
  for (int m = 0; m < 6; ++m) std::fill(out[m] + used, out[m] + design_size, 0.0);
  for (int first = 0; first < used; first += lanes) {
    Design<D> seeded;
    D* number = &seeded.gravity.x;
    for (int i = 0; i < used; ++i) number[i] = value[i];
    const int count = std::min(lanes, used - first);
    for (int i = 0; i < count; ++i) number[first + i].d[i] = 1.0;
    const Machine<D> machine(seeded, joint);
    const Pose<D> p = constant<D>(platform), b = constant<D>(base);
    const Vec6<D> residual = rayleigh_residuals(machine, Geometry<D>(seeded, p, b), p.R, modes);
    for (int m = 0; m < 6; ++m)
      for (int i = 0; i < count; ++i) out[m][first + i] = residual[m].d[i];
  }
}

/// Derivatives of the six omega^2 by the platform's displacement (translation, rotation vector), exact: row m.
inline Mat6<double> pose_derivatives(const Machine<double>& machine, const Pose<double>& platform,
                                     const Pose<double>& base, const Modes& modes) {
  using D = Dual<6>;
  const Pose<D> p = displaceable<D>(platform, 0), b = constant<D>(base);
  const Vec6<D> residual = rayleigh_residuals(machine, Geometry<D>(machine.design, p, b), p.R, modes);
  Mat6<double> out;
  for (int m = 0; m < 6; ++m)
    for (int i = 0; i < 6; ++i) out[m][i] = residual[m].d[i];
  return out;
}

}  // namespace flexapod
