// A machine like a real one with nothing symmetric in it, and a pose and motions of it.
#pragma once

#include <random>

#include "model/design.hpp"
#include "model/motion.hpp"

namespace example {

using namespace flexapod;

struct Draw {
  std::mt19937_64 generator;

  explicit Draw(unsigned seed) : generator(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution(low, high)(generator); }
  Vec3<double> vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
};

inline LegPart<double> leg_part(Draw& draw) {
  return {
      draw(2.0, 4.0), {draw(0.2, 0.4), draw(-0.02, 0.02), draw(-0.02, 0.02)}, {0.02, 0.3, 0.31, 0.002, -0.001, 0.003}};
}

inline Design<double> design(Draw& draw) {
  Design<double> d{};
  d.gravity = {0.1, -0.2, -9.8};
  for (int i = 0; i < 6; ++i) {
    const double below = 1.05 * i + draw(-0.3, 0.3), above = 1.05 * i + 0.5 * (i % 2) + draw(-0.2, 0.2);
    d.b[i] = {1.2 * std::cos(below), 1.2 * std::sin(below), draw(-0.05, 0.05)};
    d.p[i] = {0.7 * std::cos(above), 0.7 * std::sin(above), draw(-0.05, 0.05)};
    d.k[i] = {-std::sin(below), std::cos(below), 0.0};
    d.leg[i] = {draw(1e6, 3e6), draw(50.0, 90.0), draw(1.0, 2.0), draw(0.5, 1.5), leg_part(draw), leg_part(draw)};
  }
  d.M = 300.0, d.R_0 = {0.02, -0.03, 0.1}, d.I_p = {30.0, 35.0, 60.0, 1.0, -2.0, 0.5};
  return d;
}

inline Pose<double> pose(Draw& draw) {
  Pose<double> pose{{draw(-0.1, 0.1), draw(-0.1, 0.1), draw(1.1, 1.3)}};
  pose.R = rotation(draw.vector(0.2));
  return pose;
}

inline Motion<double> motion(Draw& draw, const Pose<double>& pose) {
  Motion<double> motion;
  motion.pose = pose;
  motion.v = draw.vector(1.0), motion.w = draw.vector(1.0), motion.a = draw.vector(3.0),
  motion.alpha = draw.vector(3.0);
  return motion;
}

}  // namespace example
