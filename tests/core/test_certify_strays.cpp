// Models of a machine whose places stray, against long double, and whether a missing radius is noticed.
#include <doctest/doctest.h>

#include "certified_numbers.hpp"
#include "certify/limit_models.hpp"
#include "certify/strays.hpp"
#include "example.hpp"

namespace flexapod {
namespace {

constexpr int count = 5;  // of strays
struct NoRemainder : Sound {
  static constexpr bool product_remainder = false;
};

/// Each stray goes with several places, so that they are not independent.
struct Reach {
  double row[count][stray_numbers] = {};

  Reach(example::Draw& draw, const Design<double>& d, double size) {
    for (auto& each : row)
      for (int k = 0; k < stray_numbers; ++k)
        if (may_stray(d, k) && draw(0, 1) < 0.3) each[k] = size * draw(-1, 1);
  }
};

/// The places of a design at values of its strays.
struct ExactPlaces {
  Vec3<Wide> b[6], p[6], R_0, payload;
  Vec3<double> k[6];
  double M;
  Sym3<double> I_p;

  ExactPlaces(const Design<double>& d, const Vec3<double>& load, const Reach& reach, const long double (&strays)[count])
      : M(d.M), I_p(d.I_p) {
    const auto number = [&](double value, int at) {
      long double sum = value;
      for (int s = 0; s < count; ++s) sum += strays[s] * reach.row[s][at];
      return Wide(sum);
    };
    const auto vector = [&](const Vec3<double>& v, int at) {
      return Vec3<Wide>(number(v.x, at), number(v.y, at + 1), number(v.z, at + 2));
    };
    const auto place = [&](const Vec3<double>& v) { return vector(v, number_of(d, v)); };
    for (int i = 0; i < 6; ++i) b[i] = place(d.b[i]), p[i] = place(d.p[i]), k[i] = d.k[i];
    R_0 = place(d.R_0), payload = vector(load, design_size);
  }
};

/// The largest part of a radius that is used, at ends and random values of pose and strays.
template <class Rules> double most_used(example::Draw& draw, double width, double size, Joint joint) {
  using T = Taylor<Lanes, 6, 3, Rules, count>;
  const Machine<double> machine(example::design(draw), joint);
  const Reach reach(draw, machine.design, size);
  certify_task::Task task{};
  task.reach = reach.row[0], task.strays = count;
  const double load[4] = {30.0, draw(-0.3, 0.3), draw(-0.3, 0.3), draw(0.0, 0.5)};
  std::copy_n(load, 4, task.payload);
  Box box{};
  const double middle[6] = {0.05, -0.05, 1.2, 0.1, -0.1, 0.15};
  for (int i = 0; i < 6; ++i) box.low[i] = middle[i] - width, box.high[i] = middle[i] + width;
  const Box* boxes[Lanes::lanes];
  for (auto& each : boxes) each = &box;
  const StrayingPlaces<T> places(machine.design, task);
  const Numbers<T, T> models(machine, places, box_pose<T>(boxes));
  const Mat6<T> platform = loaded_platform<T>(places, load[0]);
  double most = 0;
  for (int point = 0; point < 30; ++point) {
    long double u[6], strays[count];
    const auto end = [&](bool inside) { return inside ? draw(-1, 1) : draw(-1, 1) < 0 ? -1.0 : 1.0; };
    for (long double& each : u) each = end(point % 2);
    for (long double& each : strays) each = end(point % 3 == 0);
    const ExactPlaces there(machine.design, {load[1], load[2], load[3]}, reach, strays);
    const Numbers<Wide, Wide> exact(machine, there, wide_pose(box, u));
    const Mat6<Wide> loaded = loaded_platform<Wide>(there, load[0]);
    for (int k = 0; k < 72; ++k) most = std::max(most, used(models.number[k], u, exact.number[k], strays));
    for (int r = 0; r < 6; ++r)
      for (int s = 0; s < 6; ++s) most = std::max(most, used(platform[r][s], u, loaded[r][s], strays));
  }
  return most;
}

TEST_CASE("models of a machine whose places stray hold the exact ones") {
  example::Draw draw(71);
  for (const Joint joint : {Joint::universal, Joint::spin_free})
    for (const double width : {0.0, 1e-8, 1e-3, 0.05})
      for (const double size : {1e-12, 1e-6, 1e-3, 0.02}) {
        const double most = most_used<Sound>(draw, width, size, joint);
        CHECK(most < 1.0);
        if (size > 1e-2) CHECK(most > 1e-3);  // the radii are not idle either
      }
}

TEST_CASE("without the radius of what strays together with the pose somebody notices") {
  example::Draw draw(72);
  CHECK(most_used<NoRemainder>(draw, 0.0, 0.02, Joint::universal) > 1.0);
  CHECK(most_used<NoRemainder>(draw, 1e-3, 1e-3, Joint::universal) > 1.0);
}

/// Limits with every bound that there is, as far from what the machine has that none decides for another.
sweep_task::Limits limits_about() {
  sweep_task::Limits limits{};
  for (int i = 0; i < 6; ++i) {
    limits.length[i][0] = 0.8, limits.length[i][1] = 1.7;
    limits.neutral[0][i][2] = limits.neutral[1][i][2] = 1.0;
  }
  limits.universal_angle = 0.9, limits.spherical_angle = 1.1, limits.leg_distance = 0.02;
  limits.universal_moment = 9e3, limits.spherical_moment = 1.2e4;
  return limits;
}

TEST_CASE("what limits leave over all strays is not more than at any of them") {
  using T = Taylor<Lanes, 6, 2, Sound, count>;
  using Exact = Taylor<Lanes, 6, 2>;
  example::Draw draw(74);
  int kept = 0, broken = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Design<double> d = example::design(draw);
    for (LegSprings<double>& s : d.springs) s.k_u.a[0] = draw(1e3, 1e4), s.k_u.a[1] = draw(1e3, 1e4), s.k_s = 1e4;
    const Pose<double> home = example::pose(draw);
    d.rest_position = home.t, d.rest_matrix = home.R;
    const Machine<double> machine(d, Joint::universal);
    const Reach reach(draw, d, std::pow(10.0, draw(-5.0, -2.0)));
    certify_task::Task task{};
    task.reach = reach.row[0], task.strays = count;
    Box box{};
    const double middle[6] = {0.05, -0.05, draw(1.0, 1.4), draw(-0.3, 0.3), -0.1, 0.15};
    for (int i = 0; i < 6; ++i) box.low[i] = box.high[i] = middle[i];
    const Box* boxes[Lanes::lanes];
    for (auto& each : boxes) each = &box;
    const auto judged = [&]<class U, class P>(const auto& places, const Machine<double>& of,
                                              const sweep_task::Limits& by, std::type_identity<U>,
                                              std::type_identity<P>) {
      const Pose<U> pose = box_pose<U>(boxes);
      certify_task::Finding found{};
      found.verdict = certify_task::Verdict::open, found.limit = -1;
      LimitModels<U, P>(by, &home, of, places, {-transposed(pose.R, pose.t), transpose(pose.R)}).judge(0, true, found);
      return found;
    };
    const StrayingPlaces<T> places(d, task);
    const auto all = judged(places, machine, limits_about(), std::type_identity<T>{}, std::type_identity<T>{});
    const bool proved = all.verdict == certify_task::Verdict::proved;
    (proved ? kept : broken) += 1;
    for (int point = 0; point < 60 && proved; ++point) {
      Design<double> there = d;
      double* const numbers = &there.gravity.x;
      for (int s = 0; s < count; ++s) {
        const double value = point % 2 ? draw(-1, 1) : draw(-1, 1) < 0 ? -1.0 : 1.0;
        for (int k = 0; k < design_size; ++k) numbers[k] += value * reach.row[s][k];
      }
      sweep_task::Limits by = limits_about();
      for (int i = 0; i < 6; ++i) {
        const Vec3<double> below = home.t + home.R * there.p[i] - there.b[i], above = transposed(home.R, below);
        const double to[2][3] = {{below.x, below.y, below.z}, {above.x, above.y, above.z}};
        for (int side = 0; side < 2; ++side) std::copy_n(to[side], 3, by.neutral[side][i]);
      }
      const Machine<double> of(there, Joint::universal);
      CHECK(judged(there, of, by, std::type_identity<Exact>{}, std::type_identity<double>{}).limit == -1);
    }
  }
  CHECK(kept > 5);
  CHECK(broken > 5);
}

TEST_CASE("strays in the radius are all that they can add") {
  using T = Taylor<Lanes, 2, 3, Sound, count>;
  example::Draw draw(73);
  T a(0.3);
  for (int k = 1; k < T::count; ++k) a.c[k] = Lanes(draw(-1, 1));
  a.r = Lanes(0.01);
  double all = 0.01;
  for (int k = T::terms; k < T::count; ++k) all += std::abs(lane_of(a.c[k], 0));
  const Taylor<Lanes, 2, 3> settled = a.settled();
  CHECK(lane_of(settled.r, 0) >= all);
  CHECK(lane_of(settled.r, 0) <= all * (1 + 1e-9));
  CHECK(lane_of(a.template cut<2>().c[6], 0) == lane_of(a.c[T::terms], 0));
}

}  // namespace
}  // namespace flexapod
