// Sine, cosine and the angle of a vector for packs, to about one rounding. The polynomials are Chebyshev fits of 60-digit
// values on the reduced interval, relative error below 2e-17.
#pragma once

#include "simd/pack.hpp"

namespace flexapod {

template <class T, int n> FLEXAPOD_INLINE T polynomial(const double (&c)[n], const T& z) {
  T sum(c[n - 1]);
  for (int i = n - 2; i >= 0; --i) sum = sum * z + c[i];
  return sum;
}

/// The nearest integer of |x| < 2^51.
template <class T> FLEXAPOD_INLINE T nearest(const T& x) {
  const T magic(6755399441055744.0);  // 1.5 * 2^52
  return (x + magic) - magic;
}

template <class T> struct SinCos {
  T sin, cos;

  /// |x| up to 1e6.
  explicit FLEXAPOD_INLINE SinCos(const T& x) {
    constexpr double s[] = {-0.16666666666666666,  0.008333333333330827,    -0.0001984126983657571,
                            2.755731600817155e-06, -2.5051112272573243e-08, 1.5916726193889336e-10};
    constexpr double c[] = {0.041666666666666664,   -0.0013888888888887322, 2.4801587298651292e-05,
                            -2.755731721268659e-07, 2.0876134024090145e-09, -1.1381754653662937e-11};
    const T n = nearest(x * T(0.63661977236758134));  // quarter turns; pi/2 in three parts, products n * part exact
    const T r = ((x - n * 1.5707963267341256) - n * 6.077100506303966e-11) - n * 2.0222662487959506e-21;
    const T z = r * r;
    const T sine = r + r * (z * polynomial(s, z));
    const T cosine = 1.0 - (0.5 * z - z * z * polynomial(c, z));
    const T quarter = n - 4.0 * nearest(n * T(0.25));  // -2 .. 2
    const auto odd = (abs(quarter) > 0.5) & (abs(quarter) < 1.5);
    const auto half = abs(quarter) > 1.5;
    const T first = select(odd, cosine, sine), second = select(odd, sine, cosine);
    sin = select(half | (odd & (quarter < 0.0)), -first, first);
    cos = select(half | (odd & (quarter > 0.0)), -second, second);
  }
};

/// The angle, 0 to pi, of a vector with the parts x and y >= 0.
template <class T> FLEXAPOD_INLINE T upper_angle(const T& y, const T& x) {
  constexpr double a[] = {-0.3333333333333333,  0.19999999999999804,  -0.14285714285659779, 0.11111111105150588,
                          -0.09090908753259112, 0.07692296368042296,  -0.0666642476020052,  0.05878927554473807,
                          -0.05230443640686948, 0.045515447340221615, -0.03456931506332609, 0.016284375050043393};
  constexpr double pi = 3.14159265358979323846;
  const T width = abs(x), low = min(y, width), high = max(y, width);
  const auto steep = low > 0.41421356237309503 * high;  // beyond pi/8: measure from pi/4
  const T t = select(steep, low - high, low) / select(steep, low + high, high);
  const T z = t * t;
  const T small = t + t * (z * polynomial(a, z));
  const T octant = select(steep, small + 0.25 * pi, small);
  const T quadrant = select(y > width, 0.5 * pi - octant, octant);
  return select(x < 0.0, pi - quadrant, quadrant);
}

}  // namespace flexapod
