// Where the legs are for a pose, and which pose has given leg lengths.
#pragma once

#include "model/equations.hpp"

namespace flexapod {

/// Leg lengths, and their first two time derivatives, for motions of platform and base (Eqs 6-8).
struct LegRates {
  double L[6], L_dot[6], L_ddot[6];

  LegRates(const Geometry<double>& g, const Motion<double>& platform, const Motion<double>& base) {
    for (int i = 0; i < 6; ++i) {
      const Vec3<double> V = platform.velocity_at(g.q_p[i]) - base.velocity_at(g.q_b[i]);
      const Vec3<double> A = platform.acceleration_at(g.q_p[i]) - base.acceleration_at(g.q_b[i]);
      L[i] = norm(g.S[i]);
      L_dot[i] = dot(g.S[i], V) / L[i];
      L_ddot[i] = (dot(g.S[i], A) + dot(V, V) - L_dot[i] * L_dot[i]) / L[i];
    }
  }
};

inline constexpr double least_sine = 1e-7;  // of the angle between a leg and its universal joint's axis

/// Below this length, m, a leg's direction is rounding.
inline double shortest_leg(const Design<double>& d) {
  Vec3<double> low = d.b[0], high = d.b[0];
  for (const Vec3<double>& b : d.b) {
    low = {std::min(low.x, b.x), std::min(low.y, b.y), std::min(low.z, b.z)};
    high = {std::max(high.x, b.x), std::max(high.y, b.y), std::max(high.z, b.z)};
  }
  return 1e-9 * std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

/// What makes a leg one: a length, and a direction across its universal axis (sine of the angle between them).
struct LegFit {
  double length[6], sine[6];

  explicit LegFit(const Geometry<double>& g) {
    for (int i = 0; i < 6; ++i) {
      length[i] = norm(g.S[i]);
      sine[i] = norm(cross(g.k[i], g.S[i])) / length[i];
    }
  }
};

/// Angles of the joints, rad. The neutral directions are those of the legs in the middle of their joints.
struct JointAngles {
  double first[6], second[6];  // universal joint: turn about the base axis k, then tilt out of the plane normal to k
  double universal[6];         // between the leg and its neutral direction in the base
  double spherical[6];         // between the leg and its neutral direction in the platform

  JointAngles(const Geometry<double>& g, const Pose<double>& platform, const Pose<double>& base,
              const Vec3<double> (&neutral_base)[6], const Vec3<double> (&neutral_platform)[6]) {
    for (int i = 0; i < 6; ++i) {
      const Vec3<double> n_b = base.R * neutral_base[i], n_p = platform.R * neutral_platform[i];
      const Vec3<double>&S = g.S[i], &k = g.k[i];
      const Vec3<double> from = cross(k, n_b), to = cross(k, S);  // the joint's moving axis y, neutral and now
      first[i] = std::atan2(dot(k, cross(from, to)), dot(from, to));
      second[i] = std::atan2(dot(k, S), norm(to)) - std::atan2(dot(k, n_b), norm(from));
      universal[i] = std::atan2(norm(cross(n_b, S)), dot(n_b, S));
      spherical[i] = std::atan2(norm(cross(n_p, S)), dot(n_p, S));
    }
  }
};

/// A pose found from leg lengths; `error` is the largest length error left, m.
struct FoundPose {
  Pose<double> pose;
  double error;
};

/// Levenberg-Marquardt from a start pose, base frame. It is Newton's method near a solution, and stops at the closest
/// pose where no solution can be reached.
inline FoundPose forward_kinematics(const Design<double>& d, const double (&length)[6], Pose<double> pose) {
  const Pose<double> base;
  const double reach = largest_radius(d);  // rotations are measured at the platform's size
  const auto residuals = [&](const Geometry<double>& g, Vec6<double>& r) {
    double sum = 0;
    for (int i = 0; i < 6; ++i) r[i] = norm(g.S[i]) - length[i], sum += r[i] * r[i];
    return sum;
  };
  Geometry<double> g(d, pose, base);
  Vec6<double> r;
  double cost = residuals(g, r), damping = 1e-3;
  for (int step = 0; step < 200 && damping < 1e12; ++step) {
    const Mat6<double> H = force_transformation(g);
    Mat6<double> normal;
    Vec6<double> downhill;
    for (int i = 0; i < 6; ++i)
      for (int k = 0; k < 6; ++k) {
        downhill[i] -= H[i][k] * r[k];
        for (int j = 0; j < 6; ++j) normal[i][j] += H[i][k] * H[j][k];
      }
    for (int i = 0; i < 6; ++i) normal[i][i] += damping * (i < 3 ? 1.0 : reach * reach);
    const Vec6<double> x = Cholesky<double>(normal).solve(downhill);
    const Pose<double> trial = moved(pose, x);
    const Geometry<double> trial_g(d, trial, base);
    Vec6<double> trial_r;
    const double trial_cost = residuals(trial_g, trial_r);
    if (trial_cost < cost) {
      pose = trial, g = trial_g, r = trial_r, cost = trial_cost;
      damping = std::min(damping * 0.1, cost);  // damping falls with the error: quadratic convergence
    } else {
      damping = std::max(damping * 10.0, 1e-16);
    }
  }
  double error = 0;
  for (int i = 0; i < 6; ++i) error = std::max(error, std::abs(r[i]));
  return {pose, error};
}

}  // namespace flexapod
