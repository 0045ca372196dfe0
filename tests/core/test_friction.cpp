#include <doctest/doctest.h>

#include "example.hpp"
#include "model/energy.hpp"

namespace flexapod {
namespace {

TEST_CASE("friction loses force times rate, and never gives power") {
  example::Draw draw(11);
  for (int trial = 0; trial < 100; ++trial) {
    const Design<double> design = example::design(draw);
    const JointRates<double> rate{draw(-1.0, 1.0), draw.vector(1.0), draw.vector(1.0)};
    const JointFriction<double> friction(design.leg[trial % 6], rate);
    const double power = friction.prismatic * rate.prismatic + dot(friction.universal, rate.universal) +
                         dot(friction.spherical, rate.spherical);
    CHECK(friction_power(design.leg[trial % 6], rate) == doctest::Approx(power).epsilon(1e-15));
    CHECK(power > 0.0);
  }
}

TEST_CASE("the friction in the equations of motion takes the power that it loses") {
  example::Draw draw(12);
  for (const Joint joint : {Joint::universal, Joint::spin_free}) {
    Design<double> rubbing = example::design(draw), smooth = rubbing;
    for (auto& leg : smooth.leg) leg.C_p = leg.C_u = leg.C_s = 0.0;
    CHECK(has_friction(rubbing));
    CHECK(!has_friction(smooth));
    const Motion<double> platform = example::motion(draw, example::pose(draw)), base;
    const Geometry<double> g(rubbing, platform.pose, base.pose);
    const Vec6<double> with = inverse_wrench(Machine<double>(rubbing, joint), g, platform, base);
    const Vec6<double> without = inverse_wrench(Machine<double>(smooth, joint), g, platform, base);
    const Vec6<double> twist = Vec6<double>::of(platform.v, platform.w);
    double L_0[6] = {}, power = 0;
    for (int i = 0; i < 6; ++i) power += (with[i] - without[i]) * twist[i];
    const Machine<double> machine(rubbing, joint);
    CHECK(power == doctest::Approx(energy(machine, platform, base, L_0).dissipation).epsilon(1e-10));
  }
}

}  // namespace
}  // namespace flexapod
