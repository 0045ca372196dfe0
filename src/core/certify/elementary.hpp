// Functions of Taylor models: a few terms of the series about the model's constant, and a bound of all others.
#pragma once

#include <cmath>

#include "certify/taylor.hpp"

namespace flexapod {

/// sum f_k (a - a_0)^k over k <= order, with `remainder` for the rest of the series. The f_k may be wrong by `unit`, of
/// themselves.
template <class Lane, int n, int order, class Rules, int strays>
Taylor<Lane, n, order, Rules, strays> compose(const Taylor<Lane, n, order, Rules, strays>& a,
                                              const Lane (&f)[order + 1], const Lane& remainder) {
  Taylor<Lane, n, order, Rules, strays> change = a;
  change.c[0] = Lane(0.0);
  const Lane reach = change.variation();
  Lane errors = abs(f[order]);
  for (int k = order - 1; k >= 0; --k) errors = errors * reach + abs(f[k]);
  auto sum = f[order - 1] + f[order] * change;
  for (int k = order - 2; k >= 0; --k) sum = f[k] + sum * change;
  sum.r = (sum.r + remainder + rounding::unit * errors) * rounding::up;
  return sum;
}

namespace detail {
/// reach^(order + 1) / (1 - reach): more than the rest of a power series whose coefficients are at most 1. Infinite where
/// it does not converge.
template <int order, class Lane> Lane geometric_rest(const Lane& reach) {
  Lane power = reach;
  for (int k = 0; k < order; ++k) power *= reach;
  const Lane infinite(std::numeric_limits<double>::infinity());
  return select((reach >= 0.0) & (reach < 1.0), power / (1.0 - reach), infinite);
}
}  // namespace detail

/// a^(-1/2) = c^(-1/2) sum b_k x^k with x = (a - c)/c and |b_k| falling; no bound where x may reach -1.
template <class Lane, int n, int order, class Rules, int strays>
Taylor<Lane, n, order, Rules, strays> rsqrt(const Taylor<Lane, n, order, Rules, strays>& a) {
  const Lane& c = a.c[0];
  const Lane root = rsqrt(c), inverse = 1.0 / c;
  Lane f[order + 1], next = root;
  double b = 1.0;
  for (int k = 0; k <= order; ++k) {
    f[k] = next;
    const double ratio = -(2.0 * k + 1.0) / (2.0 * k + 2.0);
    b *= ratio;
    next = next * (ratio * inverse);
  }
  const Lane reach = a.variation() * inverse * rounding::up;
  return compose(a, f, Lane(std::abs(b)) * root * detail::geometric_rest<order>(reach));
}

template <class Lane, int n, int order, class Rules, int strays>
Taylor<Lane, n, order, Rules, strays> sqrt(const Taylor<Lane, n, order, Rules, strays>& a) {
  return a * rsqrt(a);
}

/// 1/a.
template <class Lane, int n, int order, class Rules, int strays>
Taylor<Lane, n, order, Rules, strays> reciprocal(const Taylor<Lane, n, order, Rules, strays>& a) {
  const Lane inverse = 1.0 / a.c[0];
  Lane f[order + 1], next = inverse;
  for (int k = 0; k <= order; ++k) f[k] = next, next = next * -inverse;
  const Lane reach = a.variation() * abs(inverse) * rounding::up;
  return compose(a, f, abs(inverse) * detail::geometric_rest<order>(reach));
}
template <class Lane, int n, int order, class Rules, int strays>
Taylor<Lane, n, order, Rules, strays> operator/(const Taylor<Lane, n, order, Rules, strays>& a,
                                                const Taylor<Lane, n, order, Rules, strays>& b) {
  return a * reciprocal(b);
}

template <class Lane, int n, int order, class Rules, int strays>
Taylor<Lane, n, order, Rules, strays> operator/(double a, const Taylor<Lane, n, order, Rules, strays>& b) {
  return a * reciprocal(b);
}
template <class Lane, int n, int order, class Rules, int strays>
Taylor<Lane, n, order, Rules, strays> operator/(Taylor<Lane, n, order, Rules, strays> a, double b) {
  const Lane divisor(b);
  for (Lane& c : a.c) c = c / divisor;
  return a.rounded(a.r / abs(divisor));
}

/// What a C function gives in each lane.
template <class Lane, class Function, class... Lanes> Lane each_lane(Function&& function, const Lanes&... of) {
  double result[Lane::lanes];
  for (int l = 0; l < Lane::lanes; ++l) result[l] = function(lane_of(of, l)...);
  return Lane::load(result);
}

/// Sine and cosine. The derivatives are at most 1, so that the rest of the series is reach^(order + 1) / (order + 1)! at
/// most.
template <class T> struct SinCosModel {
  T sin, cos;

  explicit SinCosModel(const T& a) {
    using Lane = typename T::Number;
    constexpr int order = T::highest;
    const Lane s = each_lane<Lane>([](double x) { return std::sin(x); }, a.c[0]);
    const Lane c = each_lane<Lane>([](double x) { return std::cos(x); }, a.c[0]);
    const Lane value[4] = {s, c, -s, -c};  // and derivatives
    Lane f[order + 1], g[order + 1], rest = a.variation();
    const Lane reach = rest;
    double factorial = 1.0;
    for (int k = 0; k <= order; ++k) {
      if (k > 0) factorial *= k, rest *= reach * (1.0 / (k + 1));
      f[k] = value[k % 4] * (1.0 / factorial), g[k] = value[(k + 1) % 4] * (1.0 / factorial);
    }
    sin = compose(a, f, rest), cos = compose(a, g, rest);
  }
};

/// The angle of a vector with the parts x and y, by the arc tangent of what is left when it is turned back by the angle at
/// the centre. Where it may pass pi there is no bound.
template <class Lane, int n, int order, class Rules, int strays>
Taylor<Lane, n, order, Rules, strays> signed_angle(const Taylor<Lane, n, order, Rules, strays>& y,
                                                   const Taylor<Lane, n, order, Rules, strays>& x) {
  using T = Taylor<Lane, n, order, Rules, strays>;
  const Lane at = each_lane<Lane>([](double b, double a) { return std::atan2(b, a); }, y.c[0], x.c[0]);
  const Lane sine = each_lane<Lane>([](double a) { return std::sin(a); }, at);
  const Lane cosine = each_lane<Lane>([](double a) { return std::cos(a); }, at);
  const Lane size = abs(x.c[0]) + x.variation() + abs(y.c[0]) + y.variation();
  T across = cosine * y - sine * x, along = cosine * x + sine * y;
  across.r += 2.0 * rounding::unit * size, along.r += 2.0 * rounding::unit * size;
  const T q = across / along;
  const Lane reach = (abs(q.c[0]) + q.variation()) * rounding::up, cube = reach * reach * reach;
  T angle = at + q;
  if constexpr (order > 2) angle = angle - (q * q * q) / 3.0;
  const Lane rest = order > 2 ? cube * reach * reach / 5.0 : cube / 3.0;  // |rest| for every q, by the derivative's
  angle.r = (angle.r + rest) * rounding::up + rounding::least;
  angle.r = select(abs(at) + reach < 3.14159, angle.r, Lane(std::numeric_limits<double>::infinity()));
  return angle;
}

}  // namespace flexapod
