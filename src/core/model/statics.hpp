// Rest: where the platform settles, and the exact tangent there.
#pragma once

#include "model/displacement.hpp"
#include "model/springs.hpp"

namespace flexapod {

/// What acts on a resting machine: a wrench in the platform's frame, and the legs' unstretched lengths L_0.
struct RestLoad {
  Vec6<double> wrench;
  double L_0[6];
};

template <class T> Motion<T> at_rest(const Pose<T>& pose) {
  Motion<T> motion;
  motion.pose = pose;
  return motion;
}

/// eta less the wrenches of springs and of external loads at rest: zero at equilibrium (Eq. 34; corrections E6).
template <class T>
Vec6<T> rest_residual(const Machine<double>& machine, const Pose<T>& platform, const Pose<T>& base,
                      const RestLoad& load) {
  const Geometry<T> g(machine.design, platform, base);
  const Vec6<T> eta = inverse_wrench(machine, g, at_rest(platform), at_rest(base));
  const Vec6<T> springs = spring_wrench(machine, g, load.L_0);
  const Vec6<T> external = external_wrench(platform.R, load.wrench);
  Vec6<T> r;
  for (int i = 0; i < 6; ++i) r[i] = eta[i] - springs[i] - external[i];
  return r;
}

enum class Rest { found, singular, not_found };

/// Newton on the residual from a start pose, with exact derivatives and step halving. The pose is left where the
/// search ended.
inline Rest settle(const Machine<double>& machine, const Pose<double>& base, const RestLoad& load, Pose<double>& pose) {
  const double size = mean_radius(machine.design);  // with `force`: to compare rows and to limit steps
  double force = 0;
  for (int i = 0; i < 6; ++i) force = std::max(force, machine.stiffness(i, load.L_0[i]) * std::abs(load.L_0[i]));
  const auto merit = [&](const Vec6<double>& r) {
    double sum = 0;
    for (int i = 0; i < 6; ++i) sum += std::pow(r[i] / (i < 3 ? force : force * size), 2);
    return sum;
  };
  double current = merit(rest_residual(machine, pose, base, load));
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Vec6<Dual<6>> r = rest_residual(machine, displaceable<Dual<6>>(pose, 0), constant<Dual<6>>(base), load);
    Mat6<double> K;
    Vec6<double> negative, x;
    for (int i = 0; i < 6; ++i) {
      negative[i] = -r[i].v;
      for (int j = 0; j < 6; ++j) K[i][j] = r[i].d[j];
    }
    if (!solve_general(K, negative, x)) return Rest::singular;
    const double move = std::max(norm(x.top()) / size, norm(x.bottom()));
    double fraction = std::min(1.0, 0.3 / move);
    for (; fraction > 1e-6; fraction *= 0.5) {
      Vec6<double> step = x;
      for (double& component : step.a) component *= fraction;
      const Pose<double> trial = moved(pose, step);
      const double next = merit(rest_residual(machine, trial, base, load));
      if (next < current || (move < 1e-10 && next <= 4.0 * current)) {
        pose = trial, current = next;
        break;
      }
    }
    if (move < 1e-10) return Rest::found;  // the last step was taken, quadratically close to the solution
    if (fraction <= 1e-6) return Rest::not_found;
  }
  return Rest::not_found;
}

}  // namespace flexapod
