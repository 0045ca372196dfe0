// A spring and a damper between base and platform beside the legs: 6x6 matrices in the base's axes for a point of the
// platform, unstressed at the rest pose.
#pragma once

#include "decomposition/svd_jacobi.hpp"
#include "model/angles.hpp"
#include "model/joint_rest.hpp"
#include "model/spatial_inertia.hpp"

namespace flexapod {

template <class D, class T> Vec6<product_t<D, T>> operator*(const Sym6<D>& m, const Vec6<T>& v) {
  Vec6<product_t<D, T>> r;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) r[i] += m.at(i, j) * v[j];
  return r;
}

/// The twist of the suspension's point in base axes for one of the platform's reference point; p: the point from there.
template <class T, class U> Vec6<T> suspension_twist(const Mat3<T>& R_b, const Vec3<T>& p, const Vec6<U>& twist) {
  const Vec3<T> v = Vec3<T>(twist.top()) + cross(twist.bottom(), p);
  return Vec6<T>::of(transposed(R_b, v), transposed(R_b, Vec3<T>(twist.bottom())));
}
/// The wrench at the reference point of one at the suspension's point in base axes.
template <class T> Vec6<T> suspension_wrench_at(const Mat3<T>& R_b, const Vec3<T>& p, const Vec6<T>& wrench) {
  const Vec3<T> force = R_b * wrench.top();
  return Vec6<T>::of(force, cross(p, force) + R_b * wrench.bottom());
}

/// Adds the stiffness of the suspension to that of the platform.
template <class T, class D>
void add_suspension(SpatialInertia<T>& K, const Design<D>& d, const Mat3<T>& R_p, const Mat3<T>& R_b) {
  const auto at = [&](int r, int c) -> const D& { return d.suspension_stiffness.at(r, c); };
  const auto block = [&](int i) {
    return Sym3<D>{at(i, i), at(i + 1, i + 1), at(i + 2, i + 2), at(i + 1, i), at(i + 2, i), at(i + 2, i + 1)};
  };
  const Mat3<D> G{{{at(3, 0), at(3, 1), at(3, 2)}, {at(4, 0), at(4, 1), at(4, 2)}, {at(5, 0), at(5, 1), at(5, 2)}}};
  const Vec3<T> p = R_p * d.suspension_point;
  const Mat3<T> to_base = transpose(R_b), turned = R_b * (G * to_base);
  K.add(p, rotate(R_b, block(0)));
  K.add_coupled(p, turned, rotate(R_b, block(3)));
}

/// How far the suspension is from its rest, as seen from the base in its axes: the point's displacement, and the
/// platform's rotation vector.
template <class T> struct SuspensionStrain {
  Vec3<T> p;  // the point from the platform's reference point
  Vec3<T> displacement;
  RotationLog<T> rotation;

  template <class D>
  SuspensionStrain(const Design<D>& d, const Pose<T>& platform, const Pose<T>& base)
      : p(platform.R * d.suspension_point),
        displacement(transposed(base.R, platform.t + p - base.t) -
                     (d.rest_position + d.rest_matrix * d.suspension_point)),
        rotation(transpose(base.R) * (platform.R * transpose(d.rest_matrix))) {}
  Vec6<T> strain() const { return Vec6<T>::of(displacement, rotation.vector); }
  /// The wrench of forces on the strain's parts, at the suspension's point and in base axes.
  Vec6<T> wrench(const Vec6<T>& force) const { return Vec6<T>::of(force.top(), rotation.moment(force.bottom())); }
};

/// The twist of the suspension's point relative to the base, in base axes.
template <class T> Vec6<T> suspension_rate(const Vec3<T>& p, const Motion<T>& platform, const Motion<T>& base) {
  const Vec3<T> arm = platform.pose.t + p - base.pose.t;
  return Vec6<T>::of(transposed(base.pose.R, platform.velocity_at(p) - base.velocity_at(arm)),
                     transposed(base.pose.R, platform.w - base.w));
}

/// The wrench on the platform, at its reference point, against the suspension's spring and damper.
template <class T, class D>
Vec6<T> suspension_load(const Design<D>& d, const Motion<T>& platform, const Motion<T>& base) {
  const SuspensionStrain<T> at(d, platform.pose, base.pose);
  Vec6<T> load = at.wrench(d.suspension_stiffness * at.strain());
  const Vec6<T> lost = d.suspension_damping * suspension_rate(at.p, platform, base);
  for (int i = 0; i < 6; ++i) load[i] += lost[i];
  return suspension_wrench_at(base.pose.R, at.p, load);
}

template <class T, class D>
FLEXAPOD_APART void add_suspension_load(Vec6<T>& wrench, const Design<D>& d, const Motion<T>& platform,
                                        const Motion<T>& base) {
  const Vec6<T> load = suspension_load(d, platform, base);
  for (int i = 0; i < 6; ++i) wrench[i] += load[i];
}

/// J.
template <class D> D suspension_energy(const Design<D>& d, const Pose<D>& platform, const Pose<D>& base) {
  const Vec6<D> e = SuspensionStrain<D>(d, platform, base).strain();
  return 0.5 * dot(e, d.suspension_stiffness * e);
}
/// W.
template <class D> D suspension_loss(const Design<D>& d, const Motion<D>& platform, const Motion<D>& base) {
  const Vec6<D> rate = suspension_rate(Vec3<D>(platform.pose.R * d.suspension_point), platform, base);
  return dot(rate, d.suspension_damping * rate);
}

/// C with C C^T the suspension's stiffness, which may be semidefinite: eigenvectors of the matrix with its rows and
/// columns scaled to a diagonal of ones, since translations and rotations have different units.
inline Mat6<double> suspension_root(const Design<double>& d) {
  double size[6];
  Mat6<double> scaled;
  for (int i = 0; i < 6; ++i) {
    const double k = d.suspension_stiffness.at(i, i);
    size[i] = k > 0 ? std::sqrt(k) : 1.0;
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) scaled[i][j] = d.suspension_stiffness.at(i, j) / (size[i] * size[j]);
  const SingularValues of(scaled);  // of a positive semidefinite matrix: its eigenvalues and eigenvectors
  Mat6<double> C;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) C[i][j] = size[i] * of.u[i][j] * std::sqrt(of.sigma[j]);
  return C;
}

}  // namespace flexapod
