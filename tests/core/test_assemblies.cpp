// Homotopy continuation: the equations, the 40 solutions of a general machine, and all assemblies of a real one.
#include <doctest/doctest.h>

#include "model/assemblies.hpp"

using namespace flexapod;
using namespace flexapod::assemblies;

namespace {

Study any_point(General& random) {
  Study x;
  for (Complex& z : x.a) z = random.number();
  return x;
}

double misfit(const Numbers& numbers, const Study& x) {
  double most = std::abs(x[0] * x[4] + x[1] * x[5] + x[2] * x[6] + x[3] * x[7]);
  for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(half_product(gradient(numbers, i, x), x)));
  return most;
}

}  // namespace

TEST_CASE("the gradient is that of the quadratic form") {
  General random(1);
  const Numbers numbers = general_numbers(random);
  const Study x = any_point(random), y = any_point(random);
  for (int i = 0; i < 6; ++i) {  // f(x + y) - f(x - y) = 2 y . grad f(x), exactly
    const Study ahead = sum(x, 1.0, y), behind = sum(x, -1.0, y);
    const Complex difference =
        half_product(gradient(numbers, i, ahead), ahead) - half_product(gradient(numbers, i, behind), behind);
    CHECK(std::abs(difference - 4.0 * half_product(gradient(numbers, i, x), y)) < 1e-11);
  }
}

TEST_CASE("the quadratic form is the length of a leg") {
  General random(2);
  Study x;
  for (Complex& z : x.a) z = random.number().real();
  x[4] = -(x[1] * x[5] + x[2] * x[6] + x[3] * x[7]) / x[0];
  Design<double> design{};
  for (auto* joints : {&design.b, &design.p})
    for (auto& joint : *joints) joint = {random.number().real(), random.number().real(), random.number().real()};
  const Scaled scaled(design);
  const Geometry<double> geometry(design, scaled.pose(x), Pose<double>{});
  double lengths[6];
  for (int i = 0; i < 6; ++i) lengths[i] = norm(geometry.S[i]);
  CHECK(misfit(scaled.numbers(lengths), x) < 1e-13);
}

TEST_CASE("a general machine has forty solutions") {
  const Solved& solved = general();
  CHECK(solved.complete);
  REQUIRE(solved.points.size() == most);
  for (std::size_t i = 0; i < most; ++i) {
    CHECK(misfit(solved.numbers, solved.points[i]) < 1e-12);
    for (std::size_t j = 0; j < i; ++j) CHECK(apart(solved.points[i], solved.points[j]) > 1e-4);
  }
}
