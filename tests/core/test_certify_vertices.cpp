// The vertex test against eigenvalues at many points, and whether it notices what it must.
#include <doctest/doctest.h>

#include "certify/halving.hpp"
#include "example.hpp"

namespace flexapod {
namespace {

using Lanes = Pack<Vector, 1>;
struct CountedSquares : Sound {
  static constexpr bool drop_squares = false;
};

/// A matrix of models with the unit matrix at the centre; its coefficients in all lanes.
template <int n, class Rules> MatrixModel<Taylor<Lanes, n, 3, Rules>> drawn(example::Draw& draw, double size) {
  MatrixModel<Taylor<Lanes, n, 3, Rules>> A;
  for (int r = 0; r < 6; ++r)
    for (int s = 0; s <= r; ++s) {
      auto& a = A.a[entry(r, s)];
      a = Taylor<Lanes, n, 3, Rules>(r == s ? 1.0 : 0.0);
      constexpr const auto& m = monomials<n, 3>;
      for (int k = 1; k < a.count; ++k) a.c[k] = Lanes(size * draw(-1, 1) * std::pow(0.3, m.degree[k]));
      a.r = Lanes(0.01 * size);
    }
  return A;
}

/// Whether A at u, with all radii taken against it along one vector, has a negative value there.
template <int n, class Rules>
double value(const MatrixModel<Taylor<Lanes, n, 3, Rules>>& A, const double (&u)[n], const double (&v)[6]) {
  constexpr const auto& m = monomials<n, 3>;
  double sum = 0;
  for (int r = 0; r < 6; ++r)
    for (int s = 0; s < 6; ++s) {
      const auto& a = A.a[entry(r, s)];
      double entry = 0;
      for (int k = 0; k < a.count; ++k) {
        double term = lane_of(a.c[k], 0);
        for (int i = 0; i < n; ++i)
          for (int p = 0; p < m.power[k][i]; ++p) term *= u[i];
        entry += term;
      }
      sum += entry * v[r] * v[s] - lane_of(a.r, 0) * std::abs(v[r] * v[s]);
    }
  return sum;
}

template <int n, class Rules> bool proved(const MatrixModel<Taylor<Lanes, n, 3, Rules>>& A) {
  HalvingTest<Lanes, n, Rules> test;
  bool positive[Lanes::lanes];
  test(A, 1, positive);
  return positive[0];
}

/// The least value at many points, of directions that go downhill.
template <int n, class Rules>
double least(example::Draw& draw, const MatrixModel<Taylor<Lanes, n, 3, Rules>>& A, int points) {
  double found = 1.0;
  for (int point = 0; point < points; ++point) {
    double u[n], v[6];
    for (double& each : u) each = draw(0, 1) < 0.5 ? draw(-1, 1) : draw(-1, 1) < 0 ? -1 : 1;
    for (double& each : v) each = draw(-1, 1);
    double here = value(A, u, v);
    for (int step = 0; step < 60; ++step) {
      double w[6];
      for (int i = 0; i < 6; ++i) w[i] = v[i] + 0.3 * draw(-1, 1);
      double norm_v = 0, norm_w = 0;
      for (int i = 0; i < 6; ++i) norm_v += v[i] * v[i], norm_w += w[i] * w[i];
      const double there = value(A, u, w);
      if (there / norm_w < here / norm_v) std::copy_n(w, 6, v), here = there;
    }
    found = std::min(found, here);
  }
  return found;
}

TEST_CASE("what is proved positive definite is so wherever it is looked at") {
  example::Draw draw(41);
  int yes = 0, no = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const auto A = drawn<2, Sound>(draw, draw(0.05, 1.6));
    const bool positive = proved(A);
    (positive ? yes : no) += 1;
    if (positive) CHECK(least(draw, A, 30) > 0.0);
  }
  CHECK(yes > 20);
  CHECK(no > 20);
}

TEST_CASE("convex squares do not count at vertices; a rule that counts them proves what is false") {
  const auto bowl = [](auto rules) {
    MatrixModel<Taylor<Lanes, 2, 3, decltype(rules)>> A;
    for (int r = 0; r < 6; ++r)
      for (int s = 0; s <= r; ++s) A.a[entry(r, s)] = Taylor<Lanes, 2, 3, decltype(rules)>(r == s ? 1.0 : 0.0);
    constexpr const auto& m = monomials<2, 3>;
    A.a[0].c[0] = Lanes(-0.5), A.a[0].c[m.at(0, 0)] = Lanes(1.0);  // u_0^2 - 1/2
    return proved(A);
  };
  CHECK(!bowl(Sound{}));
  CHECK(bowl(CountedSquares{}));
}

TEST_CASE("halves prove a bowl that its vertices do not") {
  MatrixModel<Taylor<Lanes, 2, 3>> A;
  for (int r = 0; r < 6; ++r)
    for (int s = 0; s <= r; ++s) A.a[entry(r, s)] = Taylor<Lanes, 2, 3>(r == s ? 1.0 : 0.0);
  constexpr const auto& m = monomials<2, 3>;
  A.a[0].c[0] = Lanes(0.3), A.a[0].c[m.at(0)] = Lanes(0.5), A.a[0].c[m.at(0, 0)] = Lanes(0.5);  // least 0.175
  VertexTest<Lanes, 2, Sound> vertices;
  CHECK(!any(vertices(A).positive));
  CHECK(proved(A));
  A.a[0].c[0] = Lanes(0.12);  // least -0.005
  CHECK(!proved(A));
}

TEST_CASE("a halved polynomial is the polynomial on the half") {
  example::Draw draw(42);
  constexpr const auto& m = monomials<3, 3>;
  double c[20], below[20], above[20];
  for (int axis = 0; axis < 3; ++axis)
    for (int trial = 0; trial < 20; ++trial) {
      for (double& each : c) each = draw(-1, 1);
      HalvingTest<Lanes, 3, Sound>::halves(c, axis, below, above);
      const double u[3] = {draw(-1, 1), draw(-1, 1), draw(-1, 1)};
      const auto at = [&](const double (&coefficients)[20], double moved) {
        double sum = 0;
        for (int k = 0; k < 20; ++k) {
          double term = coefficients[k];
          for (int i = 0; i < 3; ++i)
            for (int p = 0; p < m.power[k][i]; ++p) term *= i == axis ? moved : u[i];
          sum += term;
        }
        return sum;
      };
      CHECK(at(below, u[axis]) == doctest::Approx(at(c, -0.5 + 0.5 * u[axis])).epsilon(1e-13));
      CHECK(at(above, u[axis]) == doctest::Approx(at(c, 0.5 + 0.5 * u[axis])).epsilon(1e-13));
    }
}

TEST_CASE("a matrix without its negative part is not negative") {
  example::Draw draw(43);
  for (int trial = 0; trial < 200; ++trial) {
    Symmetric6<Lanes> D, N, sum;
    for (Lanes& each : D) each = Lanes(draw(-1, 1) * std::pow(10.0, draw(-8, 2)));
    negative_part(D, N);
    double size = 0;
    for (int k = 0; k < symmetric_size; ++k) sum[k] = D[k] + N[k], size += std::abs(lane_of(D[k], 0));
    for (int r = 0; r < 6; ++r) sum[entry(r, r)] += Lanes(1e-10 * size), N[entry(r, r)] += Lanes(1e-10 * size);
    CHECK(any(positive_definite(sum)));
    CHECK(any(positive_definite(N)));
  }
  Symmetric6<Lanes> indefinite;
  for (int r = 0; r < 6; ++r)
    for (int s = 0; s <= r; ++s) indefinite[entry(r, s)] = Lanes(r == s ? 1.0 : 0.0);
  CHECK(any(positive_definite(indefinite)));
  indefinite[entry(5, 4)] = Lanes(1.0 + 1e-15);
  CHECK(!any(positive_definite(indefinite)));
  indefinite[entry(5, 4)] = Lanes(std::numeric_limits<double>::quiet_NaN());
  CHECK(!any(positive_definite(indefinite)));
}

}  // namespace
}  // namespace flexapod
