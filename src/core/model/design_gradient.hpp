// What a search for a better design asks of a machine at a pose: frequencies and geometry with exact derivatives along
// given directions, each a change of the numbers of the design together with a displacement of the pose.
#pragma once

#include "model/kinematics.hpp"
#include "model/modes.hpp"

namespace flexapod {

inline constexpr int gradient_lanes = 8;
using Seed = Dual<gradient_lanes>;

/// The machine, and poses, with the derivatives along directions, some at a time.
struct SeededDesign {
  Machine<Seed> machine;
  int count = 0;

  /// numbers: how many of the design's are used.
  SeededDesign(Joint joint, const Features& features, int numbers) : machine(joint, features), numbers_(numbers) {}
  /// directions: rows of `design_size`.
  void set(const Design<double>& d, const double* directions, int count_) {
    count = count_;
    const double* value = &d.gravity.x;
    Seed* number = &machine.design.gravity.x;
    for (int i = 0; i < numbers_; ++i) {
      number[i] = value[i];
      for (int k = 0; k < count; ++k) number[i].d[k] = directions[k * design_size + i];
    }
    machine.refresh();
  }
  /// displacements: rows of translation and rotation vector.
  Pose<Seed> pose(const Pose<double>& at, const double* displacements) const {
    Seed x[6];
    for (int i = 0; i < 6; ++i)
      for (int k = 0; k < count; ++k) x[i].d[k] = displacements[k * 6 + i];
    return displaced(at, Vec3<Seed>(x[0], x[1], x[2]), Vec3<Seed>(x[3], x[4], x[5]));
  }

 private:
  int numbers_;
};

/// v_a^T (dK - lambda dJ) v_b for all pairs of modes, lambda the mean of the two. The diagonal are the derivatives of
/// omega^2; for modes of one frequency the eigenvalues of the block are those along the direction.
inline void rayleigh_matrix(const Machine<Seed>& machine, const Geometry<Seed>& g, const Mat3<Seed>& R,
                            const Modes& modes, Seed (&out)[6][6]) {
  const Mat6<Seed> J = inertia(machine, g, R);
  const bool others = machine.features.others();
  Mat6<Seed> K;
  if (others) K = other_stiffness(machine, g, R, Mat3<Seed>::identity());
  const SpringMatrix<Seed> directions = spring_directions(g);
  Seed stretch[6][spring_count];
  for (int a = 0; a < 6; ++a) {
    Vec6<double> shape;
    for (int r = 0; r < 6; ++r) shape[r] = modes.shape[r][a];
    spring_rates(directions, shape, stretch[a]);
    Vec6<Seed> momentum, force;
    for (int i = 0; i < 6; ++i)
      for (int r = 0; r < 6; ++r) momentum[i] += shape[r] * J[i][r];
    if (others)
      for (int i = 0; i < 6; ++i)
        for (int r = 0; r < 6; ++r) force[i] += shape[r] * K[i][r];
    for (int b = 0; b <= a; ++b) {
      const double lambda = 0.5 * (modes.omega[a] * modes.omega[a] + modes.omega[b] * modes.omega[b]);
      Seed sum =
          with_stiffness(machine, g, [&](const auto& k) { return stiffness_product(k, stretch[a], stretch[b]); });
      if (others)
        for (int i = 0; i < 6; ++i) sum += modes.shape[i][b] * force[i];
      for (int i = 0; i < 6; ++i) sum -= (lambda * modes.shape[i][b]) * momentum[i];
      out[a][b] = out[b][a] = sum;
    }
  }
}

/// Squares of the bending moments of universal and spherical joints, for a base in the inertial frame.
inline void squared_moments(const Machine<Seed>& machine, const Geometry<Seed>& g, const Mat3<Seed>& R,
                            Seed (&out)[2][6]) {
  for (int i = 0; i < 6; ++i) {
    const LegSprings<Seed>& k = machine.design.springs[i];
    const JointSprings<Seed> of(k, machine.rest[i], LegAxes<Seed>(g.S[i], g.k[i], machine.joint), g.k[i], R,
                                Mat3<Seed>::identity(), machine.joint);
    const Seed first = k.k_u[0] * of.first, second = k.k_u[1] * of.second;
    out[0][i] = first * first + second * second;
    out[1][i] = k.k_s * k.k_s * of.bend_2;
  }
}

/// Cosines of the angles of universal and spherical joints from their directions at home; without a home pose from the
/// z axes of base and platform.
inline void joint_cosines(const SeededDesign& seeded, const Pose<Seed>& at, const Pose<Seed>* home, Seed (&out)[2][6]) {
  for (int i = 0; i < 6; ++i) {
    const auto leg = [&](const Pose<Seed>& pose) {
      return pose.t + pose.R * seeded.machine.design.p[i] - seeded.machine.design.b[i];
    };
    Vec3<Seed> in_base(0.0, 0.0, 1.0), in_platform(0.0, 0.0, 1.0);
    if (home != nullptr) {
      const Vec3<Seed> S = leg(*home);
      in_base = rsqrt(dot(S, S)) * S;
      in_platform = transposed(home->R, in_base);
    }
    const Vec3<Seed> S = leg(at), s = rsqrt(dot(S, S)) * S;
    out[0][i] = dot(in_base, s);
    out[1][i] = dot(at.R * in_platform, s);
  }
}

}  // namespace flexapod
