// How far the legs are from one another, by pairs: (1, 2), (1, 3), ... (5, 6).
#pragma once

#include "model/equations.hpp"

namespace flexapod {

inline constexpr int leg_pairs = 15;

/// Calls f(pair, i, j) for every pair of legs i < j.
template <class F> void for_leg_pairs(F&& f) {
  int pair = 0;
  for (int i = 0; i < 5; ++i)
    for (int j = i + 1; j < 6; ++j) f(pair++, i, j);
}

/// The pairs of legs whose joints on a plate are at one point, but for rounding.
inline void shared_joints(const EachLeg<Vec3<double>>& joints, bool (&shared)[leg_pairs]) {
  Vec3<double> low = joints[0], high = joints[0];
  for (const auto& at : joints) {
    low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
  }
  const Vec3<double> extent = high - low;
  const double least = 1e-9 * std::max({extent.x, extent.y, extent.z});
  for_leg_pairs([&](int pair, int i, int j) {
    const Vec3<double> r = joints[i] - joints[j];
    shared[pair] = std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)}) <= least;
  });
}

/// Which pairs of a design's legs share a joint on the base, and which on the platform.
struct SharedJoints {
  bool base[leg_pairs], platform[leg_pairs];

  explicit SharedJoints(const Design<double>& d) { shared_joints(d.b, base), shared_joints(d.p, platform); }
};

/// Distance of the point x from the segment q + t b (0 <= t <= 1), without branches.
template <class T> T point_distance(const Vec3<T>& x, const Vec3<T>& q, const Vec3<T>& b) {
  const Vec3<T> r = x - q;
  return norm(r - clamp(dot(r, b) / dot(b, b), T(0.0), T(1.0)) * b);
}

/// Where the segments p + s a (0 <= s <= 1) and q + t b (0 <= t <= 1) are closest, without branches.
template <class T> struct ClosestPoints {
  T s, t;

  ClosestPoints(const Vec3<T>& p, const Vec3<T>& a, const Vec3<T>& q, const Vec3<T>& b) {
    const T zero(0.0), one(1.0);
    const Vec3<T> r = p - q;
    const T aa = dot(a, a), bb = dot(b, b), ab = dot(a, b), ar = dot(a, r), br = dot(b, r);
    const T determinant = aa * bb - ab * ab;
    const T parallel = T(1e-14) * aa * bb;  // parallel segments: any s will do, the clamps below find the rest
    const T s0 = clamp((ab * br - bb * ar) / max(determinant, parallel), zero, one);
    t = clamp((ab * s0 + br) / bb, zero, one);
    s = clamp((ab * t - ar) / aa, zero, one);
  }
};
template <class T> T segment_distance(const Vec3<T>& p, const Vec3<T>& a, const Vec3<T>& q, const Vec3<T>& b) {
  const ClosestPoints<T> at(p, a, q, b);
  return norm(p - q + at.s * a - at.t * b);
}

/// Distance of two leg axes. Legs that meet at a common joint are as far apart as the other joint of either is from the
/// other leg; legs that share both joints are one line.
template <class T, class P>
T pair_distance(const Geometry<T, P>& g, const SharedJoints& shared, int pair, int i, int j) {
  const Vec3<T>&p = g.q_b[i], &a = g.S[i], &q = g.q_b[j], &b = g.S[j];
  if (shared.base[pair] && shared.platform[pair]) return T(0.0);
  if (shared.base[pair]) return min(point_distance(p + a, q, b), point_distance(q + b, p, a));
  if (shared.platform[pair]) return min(point_distance(p, q, b), point_distance(q, p, a));
  return segment_distance(p, a, q, b);
}

/// Least distance between any two leg axes.
template <class T, class P> T least_leg_distance(const Geometry<T, P>& g, const SharedJoints& shared) {
  T least(std::numeric_limits<double>::infinity());
  for_leg_pairs([&](int pair, int i, int j) { least = min(least, pair_distance(g, shared, pair, i, j)); });
  return least;
}

}  // namespace flexapod
