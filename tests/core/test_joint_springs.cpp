#include <doctest/doctest.h>

#include "decomposition/singular_lanes.hpp"
#include "example.hpp"
#include "model/frequency_derivatives.hpp"
#include "model/rotation.hpp"
#include "model/statics.hpp"

namespace flexapod {
namespace {

/// The example with springs in its joints and a suspension, at rest in a pose of its own.
Design<double> sprung(example::Draw& draw) {
  Design<double> d = example::design(draw);
  for (LegSprings<double>& s : d.springs) {
    s.k_u.a[0] = draw(1e4, 3e4), s.k_u.a[1] = draw(1e4, 3e4), s.k_s = draw(1e4, 3e4), s.k_t = draw(1e4, 3e4);
    s.series_compliance = draw(1e-8, 1e-7);
  }
  const Pose<double> rest = example::pose(draw);
  d.rest_position = rest.t, d.rest_matrix = rest.R;
  d.suspension_point = draw.vector(0.3);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) {
      double& k = d.suspension_stiffness.a[Sym6<double>::place(i, j)];
      k = i == j ? draw(2e4, 4e4) : draw(-2e3, 2e3);
    }
  return d;
}

struct Case {
  example::Draw draw{11};
  Design<double> design = sprung(draw);
  Pose<double> pose = example::pose(draw), base;
  Case() { base.R = rotation({0.3, -0.2, 0.5}), pose.t = base.R * pose.t, pose.R = base.R * pose.R; }
  Geometry<double> geometry() const { return {design, pose, base}; }
};

TEST_CASE("the closed form of the joints' stiffness is the sum over their springs, in both joint models") {
  for (const Joint joint : {Joint::universal, Joint::spin_free}) {
    const Case c;
    const Machine<double> machine(c.design, joint);
    const Mat6<double> K = other_stiffness(machine, c.geometry(), c.pose.R, c.base.R);
    const auto F = spring_matrix(machine, c.geometry(), c.pose.R, c.base.R);
    double largest = 0;
    for (int r = 0; r < 6; ++r) largest = std::max(largest, K[r][r]);
    for (int r = 0; r < 6; ++r)
      for (int s = 0; s < 6; ++s) {
        double sum = 0;
        for (int j = spring_count; j < all_springs; ++j) sum += F[r][j] * F[s][j];
        CHECK(std::abs(K[r][s] - sum) < 1e-14 * largest);
      }
  }
}

TEST_CASE("a joint's angles change at the rates of its directions, where it is unstressed") {
  using D = Dual<6>;
  for (const Joint joint : {Joint::universal, Joint::spin_free}) {
    Case c;
    c.design.rest_matrix = transpose(c.base.R) * c.pose.R, c.design.rest_position = transposed(c.base.R, c.pose.t);
    const Machine<double> machine(c.design, joint);
    const Geometry<D> g(c.design, displaceable<D>(c.pose, 0), constant<D>(c.base));
    for (int i = 0; i < 6; ++i) {
      const LegAxes<D> leg(g.S[i], g.k[i], joint);
      const JointSprings<D> found(c.design.springs[i], machine.rest[i], leg, g.k[i], displaceable<D>(c.pose, 0).R,
                                  constant<D>(c.base).R, joint);
      const Geometry<double> still = c.geometry();
      const JointDirections<double> expected(LegAxes<double>(still.S[i], still.k[i], joint), still.q_p[i], joint);
      for (int k = 0; k < 6; ++k) {
        const double second = joint == Joint::universal ? -found.second.d[k] : found.second.d[k];  // tilt: against y
        CHECK(found.first.d[k] == doctest::Approx(expected.d[0][k]).epsilon(1e-12));
        CHECK(second == doctest::Approx(expected.d[1][k]).epsilon(1e-12));
        CHECK(found.twist.d[k] == doctest::Approx(expected.d[4][k]).epsilon(1e-12));
      }
      CHECK(std::abs(found.bend_2.v) < 1e-30);
    }
  }
}

TEST_CASE("theta over sine keeps its digits from zero to near a half turn") {
  for (const double theta : {0.0, 1e-12, 1e-6, 1e-3, 0.1, 0.2003, 0.2005, 0.5, 1.5, 3.0}) {
    const double s = std::sin(theta), c = std::cos(theta);
    const AngleRatio<double> ratio(s, c);
    CHECK(ratio.value == doctest::Approx(theta > 0 ? theta / s : 1.0).epsilon(4e-16));
    const long double t = theta, sl = std::sin(t), cl = std::cos(t);
    const double slope = theta > 1e-2 ? double((t / sl * cl - 1.0L) / (sl * sl)) : -1.0 / 3 - 8.0 / 30 * (1 - c);
    CHECK(ratio.slope == doctest::Approx(slope).epsilon(1e-13));
  }
}

TEST_CASE("a rotation's vector comes back from its matrix, and its moment does the vector's work") {
  for (const double size : {1e-9, 1e-3, 0.19, 0.21, 1.0, 3.0}) {
    const Vec3<double> e = (size / std::sqrt(14.0)) * Vec3<double>(1.0, -2.0, 3.0), f(0.7, 0.2, -0.4);
    const RotationLog<double> log(rotation(e));
    CHECK(norm(log.vector - e) < 1e-15 * (1 + size / (3.2 - size)));
    for (const Vec3<double>& w : {Vec3<double>(1, 0, 0), Vec3<double>(0, 1, 0), Vec3<double>(0, 0, 1)})
      CHECK(dot(log.moment(f), w) == doctest::Approx(dot(f, rotation_vector_rate(e, w))).epsilon(1e-13));
  }
}

TEST_CASE("a triangular root of a semidefinite matrix, of any rank and in any units") {
  example::Draw draw(3);
  for (int rank = 0; rank <= 6; ++rank) {
    double columns[6][6] = {};
    for (int j = 0; j < rank; ++j)
      for (int i = 0; i < 6; ++i) columns[i][j] = draw(-1, 1) * (i < 3 ? 1e4 : 1e-2);
    Mat6<double> m;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        for (int k = 0; k < 6; ++k) m[i][j] += columns[i][k] * columns[j][k];
    const Mat6<double> C = semidefinite_root(m);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        double sum = 0;
        for (int k = 0; k < 6; ++k) sum += C[i][k] * C[j][k];
        const auto trace = [&](int r) { return r < 3 ? m[0][0] + m[1][1] + m[2][2] : m[3][3] + m[4][4] + m[5][5]; };
        const double size = std::sqrt(trace(i) * trace(j)) + 1e-284;
        CHECK(std::abs(sum - m[i][j]) <= 2e-15 * size);
        if (j > i) CHECK(C[i][j] == 0.0);
      }
  }
}

TEST_CASE("a triangle of two blocks has their singular values") {
  example::Draw draw(4);
  Blocks<double> blocks{};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      blocks.A[i][j] = draw(-1, 1);
      if (j <= i) blocks.C[i][j] = draw(-0.1, 0.1);
    }
  double expected[6], found[6];
  squares_by_rotations(blocks.joined(), expected);
  Blocks<double> overwritten = blocks;
  squares_by_rotations(square_factor(overwritten), found);
  for (int i = 0; i < 6; ++i) CHECK(found[i] == doctest::Approx(expected[i]).epsilon(1e-13));
}

TEST_CASE("derivatives of frequencies by every number of the design are those of differences") {
  Case c;
  c.base = Pose<double>();
  const Machine<double> machine(c.design, Joint::universal);
  const Modes modes = natural_modes(machine, c.geometry(), c.pose.R, c.base.R);
  static double by[6][design_size];
  design_derivatives(machine, c.pose, c.base, modes, by);
  const auto squares = [&](int place, double change) {
    Design<double> d = c.design;
    (&d.gravity.x)[place] += change;
    const Machine<double> m(d, Joint::universal);
    return natural_modes(m, Geometry<double>(d, c.pose, c.base), c.pose.R, c.base.R);
  };
  for (int place = 0; place < design_size; ++place) {
    const double value = (&c.design.gravity.x)[place], h = 1e-5 * std::max(std::abs(value), 1e-9);
    if (value == 0.0) continue;
    const Modes more = squares(place, h), less = squares(place, -h);
    for (int m = 0; m < 6; ++m) {
      const double square = modes.omega[m] * modes.omega[m];
      const double slope = (more.omega[m] * more.omega[m] - less.omega[m] * less.omega[m]) / (2 * h);
      CHECK(std::abs(by[m][place] - slope) * std::abs(value) < 1e-8 * square);
    }
  }
}

}  // namespace
}  // namespace flexapod
