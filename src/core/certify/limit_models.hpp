// Whether limits are kept in a whole box: each limit is a function that must not be negative.
#pragma once

#include "certify/elementary.hpp"
#include "certify/task.hpp"
#include "model/joint_springs.hpp"
#include "model/leg_distance.hpp"
#include "model/machine.hpp"

namespace flexapod {

using certify_task::BrokenLimit;

/// All limits over the boxes of all lanes, and over what strays. Values are by the legs' length or without a unit.
/// Place: the type of the design's places.
template <class T, class Place = double> class LimitModels {
  using Lane = typename T::Number;
  static constexpr int n = T::variables;

 public:
  /// places: a design, or what has its places. home: where joints are in the middle, if that strays with them.
  template <class Places>
  LimitModels(const sweep_task::Limits& limits, const Pose<double>* home, const Machine<double>& machine,
              const Places& places, const Pose<T>& base)
      : design_(machine.design) {
    const Geometry<T, Place> g(places, base);
    for (int i = 0; i < 6; ++i) {
      const T L2 = dot(g.S[i], g.S[i]), L = sqrt(L2);
      const auto* const ends = limits.length[i];
      if (ends[0] > 0.0) add(BrokenLimit::length, i, L2 - ends[0] * ends[0] * (1.0 + tiny), L2.c[0]);
      if (ends[1] < 1e150) add(BrokenLimit::length, i, ends[1] * ends[1] * (1.0 - tiny) - L2, L2.c[0]);
      Vec3<Place> below(direction(limits.neutral[0][i])), above(direction(limits.neutral[1][i]));
      if constexpr (!std::is_same_v<Place, double>)
        if (home != nullptr) {
          below = home->t + home->R * places.p[i] - places.b[i];
          above = transposed(home->R, below);
        }
      if (limits.universal_angle < pi)
        add(BrokenLimit::universal_joint, i, dot(base.R * below, g.S[i]) - cosine(limits.universal_angle, below) * L,
            L.c[0]);
      if (limits.spherical_angle < pi)
        add(BrokenLimit::spherical_joint, i, dot(above, g.S[i]) - cosine(limits.spherical_angle, above) * L, L.c[0]);
      if (machine.features.joints) moments(limits, machine, places, i, g, base.R, L);
    }
    if (limits.leg_distance > 0.0) distances(places, g, base.R, limits.leg_distance);
  }

  /// Where limits are what is to be proved, whether they are; else whether the box is outside of one, and the first that
  /// the centre breaks. Where what strays is too much at the centre already, no box about it can be proved.
  void judge(int l, bool required, certify_task::Finding& f) const {
    const Item* worst = nullptr;
    bool broken = false, kept = true;
    for (int i = 0; i < count_; ++i) {
      const Item& item = items_[i];
      if (worst == nullptr || lane_of(item.least, l) < lane_of(worst->least, l)) worst = &item;
      kept = kept && lane_of(item.least, l) >= 0.0;
      if (required && !f.hopeless && lane_of(item.centre - item.straying, l) < -tiny) f.hopeless = true;
      if (lane_of(item.most, l) < -tiny && !required) f.verdict = certify_task::Verdict::outside;
      if (lane_of(item.centre, l) < -tiny && !broken)
        broken = true, f.limit = static_cast<int>(item.limit), f.leg = item.leg;
    }
    if (!required) return;
    if (broken) f.verdict = certify_task::Verdict::broken;
    else if (kept) f.verdict = certify_task::Verdict::proved;
    double most = 0.0;
    for (int i = 0; worst != nullptr && i < n; ++i)
      if (lane_of(worst->bend[i], l) > most) most = lane_of(worst->bend[i], l), f.axis = i;
  }

 private:
  static constexpr double tiny = 0x1p-44, pi = 3.14159265358979323846;
  struct Item {
    BrokenLimit limit;
    int leg;
    Lane least, most, centre;  // bounds, and the value at the centre
    Lane straying;             // how far that may stray
    Lane bend[n];              // by u_i
  };
  const Design<double>& design_;
  Item items_[36 + 2 * leg_pairs];
  int count_ = 0;

  static Vec3<double> direction(const double (&v)[3]) { return {v[0], v[1], v[2]}; }
  /// Of the greatest angle, times the length of the direction; not too small.
  static Place cosine(double angle, const Vec3<Place>& direction) {
    return (std::cos(angle) + 0x1p-50) * norm(direction) * (1.0 + 0x1p-50);
  }

  void add(BrokenLimit limit, int leg, const T& value, const Lane& unit) {
    Item& item = start(limit, leg);
    bounds(value, item.least, item.most, item.bend);
    item.centre = value.c[0], item.straying = value.norm(T::terms, T::count);
    scale(item, unit);
  }
  Item& start(BrokenLimit limit, int leg) {
    Item& item = items_[count_++];
    item.limit = limit, item.leg = leg, item.straying = Lane(0.0);
    return item;
  }
  static void scale(Item& item, const Lane& unit) {
    const Lane factor = 1.0 / unit;
    item.least *= factor, item.most *= factor, item.centre *= factor, item.straying *= factor;
    for (Lane& bend : item.bend) bend *= factor;
  }

  /// Squares are not negative and at most 1.
  static void bounds(const T& a, Lane& least, Lane& most, Lane (&bend)[n]) {
    constexpr const auto& m = monomials<n, T::highest>;
    const Lane zero(0.0);
    Lane low = a.c[0], high = a.c[0], size = abs(a.c[0]) + a.r;
    for (int i = 0; i < n; ++i) bend[i] = zero;
    for (int k = T::terms; k < T::count; ++k) size += abs(a.c[k]), low -= abs(a.c[k]), high += abs(a.c[k]);
    for (int k = 1; k < T::terms; ++k) {
      bool square = m.degree[k] == 2;
      for (int i = 0; i < n; ++i) {
        square = square && m.power[k][i] != 1;
        if (m.power[k][i] > 0) bend[i] += abs(a.c[k]);
      }
      size += abs(a.c[k]);
      low += square ? min(a.c[k], zero) : -abs(a.c[k]);
      high += square ? max(a.c[k], zero) : abs(a.c[k]);
    }
    const Lane error = (a.r + rounding::unit * size) * rounding::up;
    least = low - error, most = high + error;
  }

  /// Of the springs in a leg's joints, in the exact joint model: about both axes of the universal joint together, and of
  /// the bending at the platform, which is an angle.
  template <class Places>
  void moments(const sweep_task::Limits& limits, const Machine<double>& machine, const Places& places, int i,
               const Geometry<T, Place>& g, const Mat3<T>& base, const T& L) {
    const LegSprings<double>& k = design_.springs[i];
    const JointRest<Place> rest = [&] {
      if constexpr (std::is_same_v<Place, double>) return machine.rest[i];
      else return JointRest<Place>(places, rest_pose(design_), i);
    }();
    if (limits.universal_moment < 1e150) {
      const LegAxes<T> leg(g.S[i], g.k[i], Joint::universal);
      const UniversalAngles<T> angle(rest, leg, g.k[i], base);
      const T first = k.k_u[0] * angle.first, second = k.k_u[1] * angle.second;
      const double square = limits.universal_moment * limits.universal_moment;
      add(BrokenLimit::moment_in_the_universal_joint, i, square * (1.0 - tiny) - first * first - second * second,
          Lane(square));
    }
    const Vec3<Place>& neutral = rest.in_platform.row[0];
    if (limits.spherical_moment < pi * k.k_s)
      add(BrokenLimit::moment_in_the_spherical_joint, i,
          dot(neutral, g.S[i]) - cosine(limits.spherical_moment / k.k_s, neutral) * L, L.c[0]);
  }

  template <class Places>
  void distances(const Places& places, const Geometry<T, Place>& g, const Mat3<T>& base, double limit) {
    const SharedJoints shared(design_);
    for_leg_pairs([&](int pair, int i, int j) {
      const LegPair legs{g.S[i], g.S[j], base * (places.b[i] - places.b[j]), places.p[i] - places.p[j]};
      const auto between = [&](int s, int s_last, int t, int t_last) {
        apart(legs, base, s, s_last, t, t_last, limit, start(BrokenLimit::distance, pair));
      };
      if (shared.base[pair] && shared.platform[pair]) add(BrokenLimit::distance, pair, T(-1.0), Lane(1.0));
      else if (shared.base[pair]) between(1, 1, 0, 1), between(0, 1, 1, 1);
      else if (shared.platform[pair]) between(0, 0, 0, 1), between(0, 1, 0, 0);
      else between(0, 1, 0, 1);
    });
  }

  /// Two legs, and from the second to the first between their joints on the base and those on the platform.
  struct LegPair {
    const Vec3<T>&first, &second;
    Vec3<T> below;
    Vec3<Place> above;
  };

  /// The parts s to s_last of the first leg and t to t_last of the second, whole or one end, are as far apart as their
  /// ends along one direction, at least: a direction fixed in the platform, or one fixed in the base. At most they are as
  /// far apart as two of their points.
  void apart(const LegPair& legs, const Mat3<T>& base, int s, int s_last, int t, int t_last, double limit, Item& item) {
    const Vec3<Lane> A = centre(legs.first), B = centre(legs.second), P = centre(legs.below), zero(0.0, 0.0, 0.0);
    const Vec3<Lane> from = P + double(s) * A - double(t) * B;
    const ClosestPoints<Lane> at(from, nudged(double(s_last - s) * A), zero, nudged(double(t_last - t) * B));
    const Lane along = s + (s_last - s) * at.s, other = t + (t_last - t) * at.t;
    const Vec3<Lane> gap = P + along * A - other * B, across = cross(A, B);
    const auto touching = dot(gap, gap) < 1e-18 * dot(B, B);
    Vec3<Lane> w(select(touching, across.x, gap.x), select(touching, across.y, gap.y),
                 select(touching, across.z, gap.z));
    w = (1.0 - 0x1p-46) * rsqrt(dot(w, w) + 1e-280) * w;  // not longer than 1
    const Mat3<Lane> R{{centre(base.row[0]), centre(base.row[1]), centre(base.row[2])}};
    along_direction(legs, w, s, s_last, t, t_last, limit, item);
    Item turning = item;
    along_direction(legs, base * transposed(R, (1.0 - 0x1p-46) * w), s, s_last, t, t_last, limit, turning);
    const auto better = turning.least > item.least;
    item.least = max(item.least, turning.least);
    for (int i = 0; i < n; ++i) item.bend[i] = select(better, turning.bend[i], item.bend[i]);
    const Vec3<T> two = legs.below + along * legs.first - other * legs.second;
    Lane least, bend[n];
    bounds(dot(two, two) - limit * limit, least, item.most, bend);
    item.most *= 1.0 / limit;
    item.centre = norm(gap) - limit;
    if constexpr (T::count > T::terms) item.straying = dot(w, two).norm(T::terms, T::count);
    scale(item, Lane(limit));
  }
  template <class W>
  void along_direction(const LegPair& legs, const Vec3<W>& w, int s, int s_last, int t, int t_last, double limit,
                       Item& item) {
    for (int i = 0; i < n; ++i) item.bend[i] = Lane(0.0);
    bool first = true;
    for (int u = s; u <= s_last; ++u)
      for (int v = t; v <= t_last; ++v) {
        const T end = u == 0 && v == 0   ? dot(w, legs.below)
                      : u == 1 && v == 1 ? T(dot(w, Vec3<T>(legs.above)))
                      : u == 1           ? dot(w, legs.below + legs.first)
                                         : dot(w, legs.below - legs.second);
        Lane least, most, bend[n];
        bounds(end - limit, least, most, bend);
        item.least = first ? least : min(item.least, least);
        for (int i = 0; i < n; ++i) item.bend[i] = max(item.bend[i], bend[i]);
        first = false;
      }
  }
  static Vec3<Lane> centre(const Vec3<T>& v) { return {v.x.c[0], v.y.c[0], v.z.c[0]}; }
  /// A part that is a point: its parameter does not matter, but is a number.
  static Vec3<Lane> nudged(const Vec3<Lane>& a) { return {a.x + 1e-150, a.y, a.z}; }
};

}  // namespace flexapod
