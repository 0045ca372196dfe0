#include <doctest/doctest.h>

#include "example.hpp"
#include "model/modes.hpp"
#include "model/statics.hpp"

namespace flexapod {
namespace {

struct Case {
  example::Draw draw{5};
  Design<double> design = example::design(draw);
  Pose<double> pose = example::pose(draw), base;
  Geometry<double> g{design, pose, base};
  Machine<double> machine{design, Joint::universal};
  SpringMatrix<double> F = leg_spring_matrix(machine, g);

  double stiffness(int r, int c) const {
    double sum = 0;
    for (int j = 0; j < spring_count; ++j) sum += F[r][j] * F[c][j];
    return sum;
  }
};

TEST_CASE("F F^T is H diag(k) H^T, where all springs lie along the legs") {
  const Case c;
  const Mat6<double> H = force_transformation(c.g), found = spring_directions(c.g);
  for (int r = 0; r < 6; ++r)
    for (int s = 0; s < 6; ++s) {
      double expected = 0;
      for (int i = 0; i < 6; ++i) expected += H[r][i] * c.design.leg[i].stiffness * H[s][i];
      CHECK(c.stiffness(r, s) == doctest::Approx(expected).epsilon(1e-13));
      CHECK(c.stiffness(r, s) == c.stiffness(s, r));
      CHECK(found[r][s] == H[r][s]);
    }
}

TEST_CASE("the rates of the springs are the derivatives of their elongations") {
  const Case c;
  using D = Dual<6>;
  const double L_0[6] = {};
  const Geometry<D> moved(c.design, displaceable<D>(c.pose, 0), constant<D>(c.base));
  D elongation[spring_count];
  elongations(moved, L_0, elongation);
  for (int k = 0; k < 6; ++k) {
    Vec6<double> twist;
    twist[k] = 1.0;
    double rate[spring_count];
    spring_rates(spring_directions(c.g), twist, rate);
    for (int j = 0; j < spring_count; ++j) CHECK(rate[j] == doctest::Approx(elongation[j].d[k]).epsilon(1e-12));
  }
}

TEST_CASE("springs push with the derivative of their energy, and stiffen by its second") {
  const Case c;
  double L_0[6], shorter[6];
  for (int i = 0; i < 6; ++i) L_0[i] = norm(c.g.S[i]), shorter[i] = L_0[i] - 1e-3 * (i + 1);
  const Machine<double> machine(c.design, Joint::universal);
  const Vec6<double> wrench = spring_wrench(machine, c.g, shorter);
  for (int k = 0; k < 6; ++k) {
    const auto at = [&](double by) {
      Vec6<double> x;
      x[k] = by;
      return Geometry<double>(c.design, moved(c.pose, x), c.base);
    };
    const double h = 1e-5;
    const auto energy = [&](double by, const double (&lengths)[6]) { return axial_energy(machine, at(by), lengths); };
    CHECK(-wrench[k] == doctest::Approx((energy(h, shorter) - energy(-h, shorter)) / (2 * h)).epsilon(1e-6));
    CHECK(c.stiffness(k, k) == doctest::Approx((energy(h, L_0) + energy(-h, L_0)) / (h * h)).epsilon(1e-6));
  }
}

TEST_CASE("modes divide the stiffness that the springs have") {
  const Case c;
  const Machine<double> machine(c.design, Joint::universal);
  const Modes modes = natural_modes(machine, c.g, c.pose.R, c.base.R);
  for (int m = 0; m < 6; ++m) {
    Vec6<double> v;
    for (int i = 0; i < 6; ++i) v[i] = modes.shape[i][m];
    double rate[spring_count];
    spring_rates(spring_directions(c.g), v, rate);
    CHECK(stiffness_product(c.machine.axial.constant, rate, rate) ==
          doctest::Approx(modes.omega[m] * modes.omega[m]).epsilon(1e-12));
  }
}

}  // namespace
}  // namespace flexapod
