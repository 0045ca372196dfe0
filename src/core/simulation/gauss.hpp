// Gauss's quadrature with three to five points.
#pragma once

namespace flexapod::gauss {

inline constexpr double node[3][5] = {
    {-0.7745966692414834, 0.0, 0.7745966692414834},
    {-0.8611363115940526, -0.33998104358485626, 0.33998104358485626, 0.8611363115940526},
    {-0.906179845938664, -0.5384693101056831, 0.0, 0.5384693101056831, 0.906179845938664}};
inline constexpr double weight[3][5] = {
    {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0},
    {0.34785484513745385, 0.6521451548625461, 0.6521451548625461, 0.34785484513745385},
    {0.23692688505618908, 0.47862867049936647, 0.5688888888888889, 0.47862867049936647, 0.23692688505618908}};

/// Points with which an oscillation's integral over `phase` radians is right to about 1e-9 of its amplitude.
inline int points(double phase) { return phase > 1.1 ? 5 : phase > 0.35 ? 4 : 3; }

/// Calls add(weight, instant) for the points between two instants.
template <class F> void each(int points, double from, double to, F&& add) {
  const double half = 0.5 * (to - from);
  for (int i = 0; i < points; ++i) add(half * weight[points - 3][i], from + half * (1.0 + node[points - 3][i]));
}

}  // namespace flexapod::gauss
