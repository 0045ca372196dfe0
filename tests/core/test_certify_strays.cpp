// Models of a machine whose places stray, against long double, and whether a missing radius is noticed.
#include <doctest/doctest.h>

#include "certified_numbers.hpp"
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
  double row[count][design_size] = {};

  Reach(example::Draw& draw, const Design<double>& d, double size) {
    for (auto& each : row)
      for (int k = 0; k < design_size; ++k)
        if (may_stray(d, k) && draw(0, 1) < 0.3) each[k] = size * draw(-1, 1);
  }
};

/// The places of a design at values of its strays.
struct ExactPlaces {
  Vec3<Wide> b[6], p[6], R_0;
  Vec3<double> k[6];
  double M;
  Sym3<double> I_p;

  ExactPlaces(const Design<double>& d, const Reach& reach, const long double (&strays)[count]) : M(d.M), I_p(d.I_p) {
    const auto number = [&](const double& value) {
      long double sum = value;
      for (int s = 0; s < count; ++s) sum += strays[s] * reach.row[s][&value - &d.gravity.x];
      return Wide(sum);
    };
    const auto place = [&](const Vec3<double>& v) { return Vec3<Wide>(number(v.x), number(v.y), number(v.z)); };
    for (int i = 0; i < 6; ++i) b[i] = place(d.b[i]), p[i] = place(d.p[i]), k[i] = d.k[i];
    R_0 = place(d.R_0);
  }
};

/// The largest part of a radius that is used, at ends and random values of pose and strays.
template <class Rules> double most_used(example::Draw& draw, double width, double size, Joint joint) {
  using T = Taylor<Lanes, 6, 3, Rules, count>;
  const Machine<double> machine(example::design(draw), joint);
  const Reach reach(draw, machine.design, size);
  certify_task::Task task{};
  task.reach = reach.row[0], task.strays = count;
  Box box{};
  const double middle[6] = {0.05, -0.05, 1.2, 0.1, -0.1, 0.15};
  for (int i = 0; i < 6; ++i) box.low[i] = middle[i] - width, box.high[i] = middle[i] + width;
  const Box* boxes[Lanes::lanes];
  for (auto& each : boxes) each = &box;
  const Numbers<T, T> models(machine, StrayingPlaces<T>(machine.design, task), box_pose<T>(boxes));
  double most = 0;
  for (int point = 0; point < 30; ++point) {
    long double u[6], strays[count];
    const auto end = [&](bool inside) { return inside ? draw(-1, 1) : draw(-1, 1) < 0 ? -1.0 : 1.0; };
    for (long double& each : u) each = end(point % 2);
    for (long double& each : strays) each = end(point % 3 == 0);
    const Numbers<Wide, Wide> exact(machine, ExactPlaces(machine.design, reach, strays), wide_pose(box, u));
    for (int k = 0; k < 72; ++k) most = std::max(most, used(models.number[k], u, exact.number[k], strays));
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
