#include <doctest/doctest.h>

#include <initializer_list>

#include "numbers/dual.hpp"
#include "numbers/vec3.hpp"

namespace flexapod {
namespace {

/// Each operation of a scalar at least once.
template <class T> T formula(const T& x, const T& y) {
  const T a = sqrt(x * x + 3.0 * y) / (1.0 + x), b = rsqrt(y + 2.0) - x;
  return max(a, b) * abs(b) - select(x < y, a * a, b) + dot(Vec3<T>(x, y, a), Vec3<T>(b, x, -y));
}

TEST_CASE("derivatives of a dual number are those of its formula") {
  using D = Dual<2>;
  for (const double x : {0.3, 0.9, 1.7}) {
    const double y = 1.1, h = 1e-6;
    const D f = formula(D::variable(x, 0), D::variable(y, 1));
    CHECK(f.v == doctest::Approx(formula(x, y)).epsilon(1e-15));
    CHECK(f.d[0] == doctest::Approx((formula(x + h, y) - formula(x - h, y)) / (2 * h)).epsilon(1e-8));
    CHECK(f.d[1] == doctest::Approx((formula(x, y + h) - formula(x, y - h)) / (2 * h)).epsilon(1e-8));
  }
}

TEST_CASE("a constant has no derivative") {
  const Dual<3> c = 2.5;
  for (const double d : (c * c / 3.0 + 1.0).d) CHECK(d == 0.0);
}

}  // namespace
}  // namespace flexapod
