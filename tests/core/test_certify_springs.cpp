// Models of stiffness laws, of springs in joints and of a suspension, and of joint moments, against long double.
#include <doctest/doctest.h>

#include "certify/limit_models.hpp"
#include "certify/stiffness_models.hpp"
#include "example.hpp"
#include "model/springs.hpp"
#include "wide.hpp"

namespace flexapod {
namespace {

struct OnePiece : Sound {
  static constexpr bool other_pieces = false;
};

void give_law(Design<double>& d, example::Draw& draw, Law law) {
  d.law = static_cast<int>(law);
  for (LegSprings<double>& s : d.springs) {
    s.series_compliance = draw(0, 1) < 0.5 ? 0.0 : draw(1e-8, 1e-6);
    s.fixed = draw(1e7, 1e8), s.axial_rigidity = draw(1e6, 1e7), s.zero_length = draw(0.3, 0.6);
    s.bulk_modulus = draw(1e8, 1e9), s.area_1 = draw(1e-3, 1e-2), s.area_2 = draw(0, 1) < 0.3 ? 0.0 : draw(1e-3, 1e-2);
    s.dead_1 = draw(0.01, 0.1), s.dead_2 = draw(0.01, 0.1), s.shortest = draw(0.3, 0.6), s.stroke = draw(1.5, 2.0);
  }
  d.table_count = 24;
  for (int j = 0; j < 24; ++j) {
    d.table_lengths.a[j] = j == 0 ? 0.5 : d.table_lengths.a[j - 1] + draw(0.01, 0.2);
    d.table_stiffnesses.a[j] = draw(1e6, 1e8);
  }
}

Design<double> sprung(example::Draw& draw) {
  Design<double> d = example::design(draw);
  for (LegSprings<double>& s : d.springs)
    s.k_u.a[0] = draw(1e3, 3e4), s.k_u.a[1] = draw(1e3, 3e4), s.k_s = draw(1e3, 3e4), s.k_t = draw(1e3, 3e4);
  const Pose<double> rest = example::pose(draw);
  d.rest_position = rest.t, d.rest_matrix = rest.R, d.suspension_point = draw.vector(0.3);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) d.suspension_stiffness.a[Sym6<double>::place(i, j)] = i == j ? 3e5 : draw(-3e4, 3e4);
  return d;
}

/// The stiffness of a law at a length, in the range of the law.
template <class T> T by_law(const Machine<double>& machine, int i, const T& L) {
  typename T::Number outside;
  return leg_stiffness(machine, i, L, false, outside);
}

template <class Rules> double most_used(unsigned seed, Law law, double width, int trials) {
  using T = Taylor<Lanes, 2, 3, Rules>;
  example::Draw draw(seed);
  double most = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Design<double> d{};
    give_law(d, draw, law);
    const Machine<double> machine(d, Joint::universal);
    T L(draw(0.8, 1.4));
    for (int k = 1; k < T::count; ++k) L.c[k] = Lanes(width * draw(-1, 1));
    const T k = by_law(machine, 2, L);
    if (!(lane_of(k.r, 0) < 1e300)) continue;
    for (int point = 0; point < 20; ++point) {
      const long double u[2] = {draw(-1, 1), point % 2 ? draw(-1, 1) : draw(-1, 1) < 0 ? -1.0 : 1.0};
      Wide length = 0;
      constexpr const auto& m = monomials<2, 3>;
      for (int c = 0; c < T::count; ++c)
        length += Wide(lane_of(L.c[c], 0)) * Wide(std::pow(u[0], m.power[c][0])) * Wide(std::pow(u[1], m.power[c][1]));
      most = std::max(most, used(k, u, machine.axial.at(d, machine.features, 2, length)));
    }
  }
  return most;
}

TEST_CASE("models of a law's stiffness hold the exact one, also where a box lies in several pieces of a table") {
  unsigned seed = 51;
  for (const Law law : {Law::screw, Law::hydraulic, Law::table})
    for (const double width : {1e-13, 1e-8, 1e-4, 0.01, 0.05}) {
      const double most = most_used<Sound>(seed++, law, width, 60);
      CHECK(most < 1.0);
      if (width > 1e-3) CHECK(most > 1e-3);
    }
}

TEST_CASE("with one piece of a table only somebody notices") {
  CHECK(most_used<OnePiece>(61, Law::table, 0.05, 60) > 1.0);
}

TEST_CASE("a box that leaves a law's range has no bound, and its centre is told") {
  using T = Taylor<Lanes, 1, 3>;
  example::Draw draw(62);
  for (const Law law : {Law::screw, Law::hydraulic, Law::table}) {
    Design<double> d{};
    give_law(d, draw, law);
    const Machine<double> machine(d, Joint::universal);
    const double least = law == Law::screw       ? d.springs[0].zero_length
                         : law == Law::hydraulic ? d.springs[0].shortest
                                                 : d.table_lengths.a[0];
    const auto look = [&](double middle, double half, bool limited, Lanes& outside) {
      T L(middle);
      L.c[1] = Lanes(half);
      return lane_of(leg_stiffness(machine, 0, L, limited, outside).r, 0) < 1e300;
    };
    Lanes outside;
    CHECK(look(least + 0.01, 0.01, false, outside));
    CHECK(lane_of(outside, 0) == 0.0);
    CHECK(!look(least + 0.01, 0.0100001, false, outside));
    CHECK(look(least + 0.01, 0.0100001, true, outside));
    look(least - 0.001, 0.0001, false, outside);
    CHECK(lane_of(outside, 0) == 1.0);
  }
}

/// What of a machine's other springs a certificate takes.
template <class T> struct OtherNumbers {
  T number[36];

  OtherNumbers(const Machine<double>& machine, const Pose<T>& pose) {
    const Pose<T> base{-transposed(pose.R, pose.t), transpose(pose.R)};
    const Geometry<T, double> g(machine.design, base);
    SpatialInertia<T> K{};
    add_other_stiffness(K, machine, g, Mat3<T>::identity(), base.R);
    const Mat6<T> matrix = K.matrix();
    for (int r = 0; r < 6; ++r)
      for (int s = 0; s < 6; ++s) number[6 * r + s] = matrix[r][s];
  }
};

Box drawn_box(example::Draw& draw, double width) {
  Box box{};
  const double middle[6] = {0.05, -0.05, 1.2, 0.1, -0.1, 0.15};
  for (int i = 0; i < 6; ++i) {
    const double half = width * draw(0.1, 1.0);
    box.low[i] = middle[i] - half, box.high[i] = middle[i] + half;
  }
  return box;
}

TEST_CASE("models of the other springs' stiffness hold the exact one, in both joint models") {
  example::Draw draw(63);
  for (const Joint joint : {Joint::universal, Joint::spin_free})
    for (const double width : {1e-12, 1e-8, 1e-3, 0.03, 0.1}) {
      using T = Taylor<Lanes, 6, 3>;
      const Machine<double> machine(sprung(draw), joint);
      const Box box = drawn_box(draw, width);
      const Box* boxes[Lanes::lanes];
      for (auto& each : boxes) each = &box;
      const OtherNumbers<T> models(machine, box_pose<T>(boxes));
      double most = 0;
      for (int point = 0; point < 40; ++point) {
        long double u[6];
        for (long double& each : u) each = point % 2 ? draw(-1, 1) : draw(-1, 1) < 0 ? -1 : 1;
        const OtherNumbers<Wide> exact(machine, wide_pose(box, u));
        for (int k = 0; k < 36; ++k) most = std::max(most, used(models.number[k], u, exact.number[k]));
      }
      CHECK(most < 1.0);
      if (width > 0.02) CHECK(most > 1e-4);
    }
}

TEST_CASE("models of a universal joint's angles hold the exact ones") {
  using T = Taylor<Lanes, 6, 2>;
  example::Draw draw(64);
  for (const double width : {1e-10, 1e-4, 0.03, 0.1}) {
    const Machine<double> machine(sprung(draw), Joint::universal);
    const Box box = drawn_box(draw, width);
    const Box* boxes[Lanes::lanes];
    for (auto& each : boxes) each = &box;
    const auto angles = [&]<class U>(const Pose<U>& pose, int i) {
      const Pose<U> base{-transposed(pose.R, pose.t), transpose(pose.R)};
      const Geometry<U, double> g(machine.design, base);
      return UniversalAngles<U>(machine.rest[i], LegAxes<U>(g.S[i], g.k[i], Joint::universal), g.k[i], base.R);
    };
    for (int i = 0; i < 6; ++i) {
      const UniversalAngles<T> models = angles(box_pose<T>(boxes), i);
      for (int point = 0; point < 20; ++point) {
        long double u[6];
        for (long double& each : u) each = point % 2 ? draw(-1, 1) : draw(-1, 1) < 0 ? -1 : 1;
        const UniversalAngles<Wide> exact = angles(wide_pose(box, u), i);
        CHECK(used(models.first, u, exact.first) < 1.0);
        CHECK(used(models.second, u, exact.second) < 1.0);
      }
    }
  }
}

TEST_CASE("the angle of a vector holds the exact one, and has no bound where it may pass pi") {
  example::Draw draw(65);
  const auto look = [&]<int order>(std::integral_constant<int, order>) {
    using T = Taylor<Lanes, 2, order>;
    for (int trial = 0; trial < 200; ++trial) {
      const double at = draw(-3.1, 3.1), size = std::pow(10.0, draw(-6.0, -0.3));
      T y(std::sin(at)), x(std::cos(at));
      for (int k = 1; k < T::count; ++k) y.c[k] = Lanes(size * draw(-0.2, 0.2)), x.c[k] = Lanes(size * draw(-0.2, 0.2));
      const T angle = signed_angle(y, x);
      if (!(lane_of(angle.r, 0) < 1e300)) continue;
      const long double u[2] = {draw(-1, 1), draw(-1, 1)};
      constexpr const auto& m = monomials<2, order>;
      long double b = 0, a = 0;
      for (int k = 0; k < T::count; ++k) {
        const long double term = std::pow(u[0], m.power[k][0]) * std::pow(u[1], m.power[k][1]);
        b += lane_of(y.c[k], 0) * term, a += lane_of(x.c[k], 0) * term;
      }
      CHECK(used(angle, u, std::atan2(b, a)) < 1.0);
    }
    T y(0.0), x(-1.0);
    y.c[1] = Lanes(0.1);
    CHECK(!(lane_of(signed_angle(y, x).r, 0) < 1e300));
  };
  look(std::integral_constant<int, 2>{});
  look(std::integral_constant<int, 3>{});
}

}  // namespace
}  // namespace flexapod
