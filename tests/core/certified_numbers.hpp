// What of a machine a certificate takes: all numbers of H and J.
#pragma once

#include "model/springs.hpp"
#include "wide.hpp"

namespace flexapod {

/// P: the type of the design's places, which are in `places`.
template <class T, class P = double> struct Numbers {
  T number[72];

  template <class Places> Numbers(const Machine<double>& machine, const Places& places, const Pose<T>& pose) {
    const Pose<T> base{-transposed(pose.R, pose.t), transpose(pose.R)};
    const Geometry<T, P> g(places, base);
    SpringMatrix<T> directions;
    SpatialInertia<T> J{};
    for (int i = 0; i < 6; ++i) {
      const LegAxes<T> leg(g.S[i], g.k[i], machine.joint);
      set_spring_directions(directions, i, g.q_p[i], leg);
      add_leg_inertia(J, leg, machine.inertia[i], g.q_p[i]);
    }
    const Mat6<T> matrix = J.matrix();
    const Mat6<P> platform = platform_inertia(places, Mat3<P>::identity()).matrix();
    for (int r = 0; r < 6; ++r)
      for (int s = 0; s < 6; ++s)
        number[6 * r + s] = directions[r][s], number[36 + 6 * r + s] = matrix[r][s] + platform[r][s];
  }
};

}  // namespace flexapod
