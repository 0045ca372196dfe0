// Taylor models against the same templates in long double, whose roundings are 2000 times smaller.
#include <doctest/doctest.h>

#include "certified_numbers.hpp"
#include "example.hpp"

namespace flexapod {

namespace {

struct NoRemainder : Sound {
  static constexpr bool product_remainder = false;
};

template <class T>
concept Compares = requires(T a) { a < a; } || requires(T a) { a > a; } || requires(T a) { a <= a; } ||
                   requires(T a) { a < 1.0; } || requires(T a) { a == a; };
static_assert(!Compares<Taylor<Lanes, 6, 3>>, "a branch on the value of a model must not compile");
static_assert(Compares<double>);

struct Trial {
  Machine<double> machine;
  Box box{};

  Trial(example::Draw& draw, double width, Joint joint) : machine(example::design(draw), joint) {
    const double middle[6] = {draw(-0.1, 0.1), draw(-0.1, 0.1), draw(1.1, 1.3),
                              draw(-0.2, 0.2), draw(-0.2, 0.2), draw(-0.2, 0.2)};
    for (int i = 0; i < 6; ++i) {
      const double half = width * draw(0.1, 1.0);
      box.low[i] = middle[i] - half, box.high[i] = middle[i] + half;
    }
  }
  template <class Rules> Numbers<Taylor<Lanes, 6, 3, Rules>> models() const {
    const Box* boxes[Lanes::lanes];
    for (auto& each : boxes) each = &box;
    return {machine, machine.design, box_pose<Taylor<Lanes, 6, 3, Rules>>(boxes)};
  }
  Numbers<Wide> exact(const long double (&u)[6]) const { return {machine, machine.design, wide_pose(box, u)}; }
  /// The largest part of a radius that is used, at vertices and random points.
  template <class Rules> double most_used(example::Draw& draw, int points) const {
    const auto models = this->models<Rules>();
    double most = 0;
    for (int point = 0; point < points; ++point) {
      long double u[6];
      for (long double& each : u) each = point % 2 ? draw(-1, 1) : draw(-1, 1) < 0 ? -1 : 1;
      const Numbers<Wide> exact = this->exact(u);
      for (int k = 0; k < 72; ++k) most = std::max(most, used(models.number[k], u, exact.number[k]));
    }
    return most;
  }
};

TEST_CASE("models of H and of the legs' inertia hold the exact ones") {
  example::Draw draw(31);
  for (const Joint joint : {Joint::universal, Joint::spin_free})
    for (const double width : {1e-12, 1e-8, 1e-3, 0.03, 0.1, 0.2})
      for (int trial = 0; trial < 4; ++trial) {
        const double most = Trial(draw, width, joint).most_used<Sound>(draw, 20);
        CHECK(most < 1.0);
        if (width > 0.02) CHECK(most > 1e-3);  // the radii are not idle either
      }
}

TEST_CASE("without the radius of products that are cut off somebody notices") {
  example::Draw draw(32);
  double most = 0;
  for (int trial = 0; trial < 5; ++trial)
    most = std::max(most, Trial(draw, 0.2, Joint::universal).most_used<NoRemainder>(draw, 20));
  CHECK(most > 1.0);
}

TEST_CASE("functions of models hold the exact ones, or know no bound") {
  using T = Taylor<Lanes, 2, 3>;
  example::Draw draw(33);
  for (int trial = 0; trial < 300; ++trial) {
    T a(draw(-3.0, 3.0));
    for (int k = 1; k < T::count; ++k) a.c[k] = Lanes(draw(-1.0, 1.0) * std::pow(10.0, draw(-6.0, -0.5)));
    a.r = Lanes(0.0);
    const long double u[2] = {draw(-1, 1), draw(-1, 1)};
    Wide x = 0;
    for (int k = 0; k < T::count; ++k) {
      constexpr const auto& m = monomials<2, 3>;
      x += Wide(lane_of(a.c[k], 0)) * Wide(std::pow(u[0], m.power[k][0])) * Wide(std::pow(u[1], m.power[k][1]));
    }
    const SinCosModel<T> turn(a);
    CHECK(used(turn.sin, u, std::sin(x.v)) < 1.0);
    CHECK(used(turn.cos, u, std::cos(x.v)) < 1.0);
    const double margin = std::abs(lane_of(a.c[0], 0)) - lane_of(a.variation(), 0);
    const T inverse = reciprocal(a);
    if (margin > 0) CHECK(used(inverse, u, 1.0L / x.v) < 1.0);
    else CHECK(!(lane_of(inverse.r, 0) < 1e300));
    const T root = rsqrt(a);
    if (margin > 0 && lane_of(a.c[0], 0) > 0) {
      CHECK(used(root, u, rsqrt(x)) < 1.0);
      CHECK(used(sqrt(a), u, sqrt(x)) < 1.0);
    } else {
      CHECK(!(lane_of(root.r, 0) < 1e300));
    }
    const T square = a * a;
    CHECK(used(turn_series(square, 1), u, std::sin(std::abs(x.v)) / std::abs(x.v)) < 1.0);
    CHECK(used(turn_series(square, 2), u, (1 - std::cos(x.v)) / (x.v * x.v)) < 1.0);
  }
}

TEST_CASE("a pose on a path holds the turned one") {
  using T = Taylor<Lanes, 1, 3>;
  example::Draw draw(34);
  for (int trial = 0; trial < 50; ++trial) {
    double pieces[6 * 6];
    for (double& each : pieces) each = draw(-1.0, 1.0);
    certify_task::Task task{};
    task.pieces = pieces, task.powers = 6;
    for (int i = 0; i < 3; ++i) task.middle[4 * i] = 1.0;
    Box span{};
    span.low[0] = draw(0.0, 0.5), span.high[0] = span.low[0] + draw(0.0, 0.3);
    const Box* boxes[Lanes::lanes];
    for (auto& each : boxes) each = &span;
    const Pose<T> pose = path_pose<T>(task, boxes);
    const long double u[1] = {draw(-1, 1)};
    const long double s = span.low[0] + (1 + u[0]) / 2 * (static_cast<long double>(span.high[0]) - span.low[0]);
    long double q[6];
    for (int i = 0; i < 6; ++i) {
      q[i] = 0;
      for (int k = 5; k >= 0; --k) q[i] = q[i] * s + pieces[6 * i + k];
    }
    const long double angle = std::sqrt(q[3] * q[3] + q[4] * q[4] + q[5] * q[5]);
    const Mat3<Wide> R = rotation<Wide>({q[3], q[4], q[5]}, angle * angle, std::sin(angle) / angle,
                                        (1 - std::cos(angle)) / (angle * angle));
    CHECK(used(pose.t.x, u, q[0]) < 1.0);
    for (int r = 0; r < 3; ++r) {
      CHECK(used(pose.R.row[r].x, u, R.row[r].x) < 1.0);
      CHECK(used(pose.R.row[r].y, u, R.row[r].y) < 1.0);
      CHECK(used(pose.R.row[r].z, u, R.row[r].z) < 1.0);
    }
  }
}

}  // namespace
}  // namespace flexapod
