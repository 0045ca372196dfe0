// The complete machine on its moving base as a first-order system (Eq. 35), the orientation on SO(3) (corrections E7).
//
// The state is the platform's displacement from rest and its velocity, both as seen from the base and in its axes, so
// that tolerances and rounding are those of the vibration however far the base travels: translation d, rotation vector
// theta of R = exp(theta) R_chart, velocities v and w, and four works. Legs feel only the base's rotation and its
// acceleration less gravity, so that neither the base's velocity nor gravity need appear beside them.
#pragma once

#include "model/springs.hpp"
#include "simulation/excitation.hpp"
#include "simulation/integrate.hpp"
#include "simulation/six_legs.hpp"
#include "simulation/task.hpp"

namespace flexapod {

using simulation_task::Measure;

/// What one simulation starts from. Inertial axes, save `wrench`.
struct MachineOnBaseInput {
  Design<double> design;
  Joint joint;
  Pose<double> platform, base;          // at rest
  Vec6<double> leg_force;               // at that pose with no command, N
  Vec6<double> wrench;                  // constant part of the external wrench, platform axes
  bool roll_pitch_yaw;                  // the base's rotation channels: else a rotation vector
  bool works;                           // integrate works beside the motion
  bool carried;                         // starts moving rigidly with the base; else from the two below
  Vec6<double> displacement, velocity;  // of the platform from rest at t = 0 (translation, rotation)
};

class MachineOnBase {
 public:
  using State = RungeKutta8<16>::State;
  static constexpr int mechanical = 12;  // numbers of the state before the works
  enum Work { of_base = 12, of_wrench, of_command, of_friction };

  PerLeg held{};      // leg forces beside the springs, N: what a controller holds between its samples
  double inside = 0;  // an instant between the corners of the excitations that the present time lies between

  MachineOnBase(const MachineOnBaseInput& input, const Excitation& base, const Excitation& wrench,
                const Excitation& command)
      : in_(input),
        machine_(without_gravity(input.design), input.joint),
        L_0_(unstretched_lengths()),
        legs_(at_rest_stiffness()),
        base_(base),
        wrench_(wrench),
        command_(command),
        rotates_(base.uses(3, 6)) {
    const Mat3<double> to_base = transpose(in_.base.R);
    rest_ = {to_base * (in_.platform.t - in_.base.t), to_base * in_.platform.R};
    friction_ = has_friction(in_.design) || machine_.features.suspension;
    law_ = machine_.features.law != Law::constant && !command_.empty();
    for (int g = 0; g < leg_groups; ++g) places_.group[g].q_b = legs_.group[g].b, places_.group[g].k = legs_.group[g].k;
    set_chart(Quaternion());
    force_ = PerLeg(in_.leg_force);
  }

  State start() {
    State y{};
    if (in_.carried) return y;
    const BaseMotion b = base_at(0.0);
    const Mat3<double> R_b = b.motion.pose.R, to_rest = transpose(in_.base.R);
    const Vec3<double> back = b.turn.inverse().resolved(to_rest).log();  // the base's turn undone, base axes
    const Vec3<double> d = transposed(R_b, in_.displacement.top() - b.travel) + turned_change(back, rest_.t);
    const Vec3<double> theta = (b.turn.inverse() * Quaternion::exp(in_.displacement.bottom())).resolved(to_rest).log();
    const Vec3<double> arm = in_.platform.t + in_.displacement.top() - b.motion.pose.t;
    const Vec3<double> v = transposed(R_b, in_.velocity.top() - b.motion.velocity_at(arm));
    const Vec3<double> w = transposed(R_b, in_.velocity.bottom() - b.motion.w);
    put(y, 0, d), put(y, 3, theta), put(y, 6, v), put(y, 9, w);
    recentre(y, 0.0);
    return y;
  }

  FLEXAPOD_FLAT void rates(double t, const State& y, State& rate, bool powers) {
    const Instant now = instant(t, y);
    put(rate, 0, now.v);
    put(rate, 3, rotation_vector_rate(get(y, 3), now.w));
    put(rate, 6, now.platform.a - now.carried_a());
    put(rate, 9, now.platform.alpha - now.carried_alpha());
    for (int i = mechanical; i < 16; ++i) rate[i] = 0.0;
    if (powers && in_.works) add_powers(now, rate);
  }

  /// Rates of the works alone, from those of the motion.
  FLEXAPOD_FLAT void powers(double t, const State& y, State& rate) {
    Instant now = placed(t, y);
    now.platform.a = get(rate, 6) + now.carried_a(), now.platform.alpha = get(rate, 9) + now.carried_alpha();
    for (int i = mechanical; i < 16; ++i) rate[i] = 0.0;
    add_powers(now, rate);
  }

  /// Moves the chart to the present orientation when that has turned by more than `limit` from it. True if it did.
  bool recentre(State& y, double limit = 1.0) {
    const Vec3<double> theta = get(y, 3);
    if (dot(theta, theta) <= limit * limit) return false;
    d_chart_ = get(y, 0);
    set_chart((Quaternion::exp(theta) * chart_).normalised());
    put(y, 3, Vec3<double>());
    return true;
  }

  /// The platform's motion in the inertial frame, with accelerations; that of the base; leg forces.
  void motions(double t, const State& y, Motion<double>& platform, Motion<double>& base, Vec6<double>& leg_force) {
    const Instant now = instant(t, y);
    leg_force = now.leg_force.six();
    const Mat3<double>& R_b = now.base.motion.pose.R;
    base = now.base.motion;
    platform.pose = {base.pose.t + R_b * now.platform.pose.t, R_b * now.platform.pose.R};
    platform.v = base.v + R_b * now.platform.v, platform.w = R_b * now.platform.w;
    platform.a = R_b * now.platform.a + in_.design.gravity, platform.alpha = R_b * now.platform.alpha;
  }

  /// Translation and rotation vector of the platform from rest, inertial axes.
  Vec6<double> displacement(double t, const State& y) {
    const BaseMotion b = base_at(t);
    const Vec3<double> carried = turned_change(b.turn.log(), in_.base.R * rest_.t);
    const Quaternion turn = Quaternion::exp(get(y, 3)) * chart_;
    return Vec6<double>::of(b.travel + b.motion.pose.R * get(y, 0) + carried,
                            (b.turn * turn.resolved(in_.base.R)).log());
  }

  /// The same as seen from the base, in its axes: what a platform that rides with the base rigidly does not have.
  Vec6<double> relative(const State& y) const {
    return Vec6<double>::of(get(y, 0), (Quaternion::exp(get(y, 3)) * chart_).log());
  }

  /// What sensors show, each as a change from rest: leg lengths, their rates, leg forces, the platform's displacement
  /// seen from the base and its rate (axes of the base at rest, turned to the inertial frame), absolute acceleration.
  void measure(double t, const State& y, double (&out)[simulation_task::signals]) {
    const Instant now = instant(t, y);
    const Mat3<double>& R_b = now.base.motion.pose.R;
    const Vec6<double> force = now.leg_force.six();
    const Geometry<double> g = geometry(y), rest(machine_.design, rest_, Pose<double>());
    const auto shown = [&](Measure measure) { return out + 6 * static_cast<int>(measure); };
    for (int i = 0; i < 6; ++i) {
      const double L = norm(g.S[i]);
      shown(Measure::leg_length)[i] = dot(g.S[i] + rest.S[i], g.S[i] - rest.S[i]) / (L + norm(rest.S[i]));
      shown(Measure::leg_rate)[i] = dot(g.S[i], now.v + cross(now.w, g.q_p[i])) / L;
      shown(Measure::leg_force)[i] = force[i] - in_.leg_force[i];
    }
    const Vec6<double> x = relative(y);
    const Vec3<double> a = R_b * now.platform.a + in_.design.gravity, alpha = R_b * now.platform.alpha;
    const Mat3<double>& R = in_.base.R;
    put(shown(Measure::position), R * x.top(), R * x.bottom());
    put(shown(Measure::velocity), R * now.v, R * now.w);
    put(shown(Measure::acceleration), a, alpha);
  }

  /// Where the legs are: base axes.
  Geometry<double> geometry(const State& y) const { return {machine_.design, pose(y), Pose<double>()}; }
  Pose<double> rest() const { return rest_; }
  /// Whether a leg's unstretched length has left the range of its stiffness law.
  bool outside_law(double t) {
    if (!law_) return false;
    Jet command[6];
    command_.at(t, inside, command);
    for (int i = 0; i < 6; ++i)
      if (std::isnan(machine_.stiffness(i, L_0_[i] + command[i].x))) return true;
    return false;
  }
  const Machine<double>& machine() const { return machine_; }

 private:
  /// All that is known at one instant; base axes but for `base`.
  struct Instant {
    BaseMotion base;
    Motion<double> frame;     // the base's rotation and its acceleration less gravity
    Motion<double> platform;  // velocity less that of the base's reference point; accelerations less gravity
    Vec3<double> v, w;        // as seen from the base
    LegPlaces at;
    PerLeg leg_force;
    Vec6<double> wrench;  // platform axes
    Jet command[6];
    Vec6<double> stiffening;  // energy in a leg by its commanded length at the same compression, N

    /// Accelerations of what has the platform's velocities as seen from the base, and keeps them.
    Vec3<double> carried_a() const {
      const Vec3<double>& r = platform.pose.t;
      return frame.a + cross(frame.alpha, r) + cross(frame.w, cross(frame.w, r) + 2.0 * v);
    }
    Vec3<double> carried_alpha() const { return frame.alpha + cross(frame.w, w); }
  };

  static Design<double> without_gravity(Design<double> d) {
    d.gravity = Vec3<double>();
    return d;
  }
  /// Unstretched lengths of the legs with no command.
  Vec6<double> unstretched_lengths() const {
    const Geometry<double> g(machine_.design, in_.platform, in_.base);
    Vec6<double> L_0;
    for (int i = 0; i < 6; ++i) L_0[i] = unstretched_length(machine_, i, norm(g.S[i]), in_.leg_force[i]);
    return L_0;
  }
  /// The machine with the stiffness along its legs that goes with these lengths.
  Machine<double> at_rest_stiffness() const {
    Machine<double> machine = machine_;
    for (int i = 0; i < 6; ++i) machine.design.leg[i].stiffness = machine_.stiffness(i, L_0_[i]);
    return machine;
  }
  static Vec3<double> get(const State& y, int i) { return {y[i], y[i + 1], y[i + 2]}; }
  static void put(double* to, const Vec3<double>& v, const Vec3<double>& w) {
    for (const double c : {v.x, v.y, v.z, w.x, w.y, w.z}) *to++ = c;
  }
  static void put(State& y, int i, const Vec3<double>& v) { y[i] = v.x, y[i + 1] = v.y, y[i + 2] = v.z; }

  BaseMotion base_at(double t) {
    Jet channel[6];
    base_.at(t, inside, channel);
    return {in_.base, channel, rotates_, in_.roll_pitch_yaw};
  }
  Pose<double> pose(const State& y) const { return {rest_.t + get(y, 0), rotation(get(y, 3)) * R_chart_}; }

  /// Without the platform's accelerations.
  FLEXAPOD_INLINE Instant placed(double t, const State& y) {
    Instant now{base_at(t), {}, {}, get(y, 6), get(y, 9), places_, {}, in_.wrench, {}, {}};
    const Motion<double>& b = now.base.motion;
    now.frame.a = transposed(b.pose.R, b.a - in_.design.gravity);
    now.frame.w = transposed(b.pose.R, b.w), now.frame.alpha = transposed(b.pose.R, b.alpha);
    now.platform.pose = pose(y);
    now.platform.v = now.v + cross(now.frame.w, now.platform.pose.t);
    now.platform.w = now.w + now.frame.w;
    set_legs(t, y, now);
    if (!wrench_.empty()) {
      Jet channel[6];
      wrench_.at(t, inside, channel);
      for (int i = 0; i < 6; ++i) now.wrench[i] += channel[i].x;
    }
    return now;
  }
  Instant instant(double t, const State& y) {
    Instant now = placed(t, y);
    const Vec6<double> wrench = external_wrench(now.platform.pose.R, now.wrench);
    const Vec6<double> acceleration = forward_dynamics(legs_, now.at, now.platform, now.frame, now.leg_force, wrench);
    now.platform.a = acceleration.top(), now.platform.alpha = acceleration.bottom();
    return now;
  }

  /// Where the legs are, from their change since the chart was set, and F = -K (L - L_0(t)) (corrections E6) from the
  /// change of length, without cancellation.
  void set_legs(double t, const State& y, Instant& now) {
    PerLeg command{};
    if (!command_.empty()) {
      command_.at(t, inside, now.command);
      Vec6<double> change;
      for (int i = 0; i < 6; ++i) change[i] = now.command[i].x;
      command = PerLeg(change);
    }
    const Vec3<double> d = get(y, 0) - d_chart_, theta = get(y, 3);
    for (int g = 0; g < leg_groups; ++g) {
      const Chart& chart = chart_legs_[g];
      GroupPlaces& at = now.at.group[g];
      const Vec3<Lanes> turned = turned_change(theta, chart.q), change = d + turned;
      at.q_p = chart.q + turned;
      at.S = chart.S + change;
      const Lanes product = dot(2.0 * chart.S + change, change);
      const Lanes stretch = product / (sqrt(chart.L * chart.L + product) + chart.L);
      now.leg_force.group[g] =
          force_.group[g] + held.group[g] + axial_force(legs_.group[g].leg, command.group[g] - stretch);
    }
    if (law_) follow_law(now);
  }

  /// Leg forces whose stiffness goes with the commanded length: k times what they are longer than the pose leaves them.
  void follow_law(Instant& now) const {
    using D = Dual<1>;
    Vec6<double> force = now.leg_force.six();
    const Vec6<double> beside = held.six();
    for (int i = 0; i < 6; ++i) {
      const double compression = (force[i] - beside[i]) / legs_.design.leg[i].stiffness;
      const D k = machine_.stiffness(i, D::variable(L_0_[i] + now.command[i].x, 0));
      force[i] = beside[i] + k.v * compression;
      now.stiffening[i] = 0.5 * k.d[0] * compression * compression;
    }
    now.leg_force = PerLeg(force);
  }

  /// Charts the orientation about `turn` from rest, and measures legs from there.
  void set_chart(const Quaternion& turn) {
    chart_ = turn, R_chart_ = turn.matrix() * rest_.R;
    for (int g = 0; g < leg_groups; ++g) {
      Chart& chart = chart_legs_[g];
      const Lanes before = chart.L;
      chart.q = R_chart_ * legs_.group[g].p;
      chart.S = (rest_.t + d_chart_) + chart.q - legs_.group[g].b;
      chart.L = sqrt(dot(chart.S, chart.S));
      force_.group[g] += axial_force(legs_.group[g].leg, before - chart.L);
    }
  }

  void add_powers(const Instant& now, State& rate) const {
    const Motion<double>& p = now.platform;
    const Vec3<double> v_b = transposed(now.base.motion.pose.R, now.base.motion.v), w_b = now.frame.w;
    if (friction_ || !base_.empty()) {
      const BaseLoad load(legs_, now.at, p, now.frame, now.leg_force);
      rate[of_base] = -(dot(load.force, v_b) + dot(load.moment, w_b));
      rate[of_friction] = -load.dissipation;
    }
    const Vec6<double> wrench = external_wrench(p.pose.R, now.wrench);
    rate[of_wrench] = dot(wrench.top(), v_b + p.v) + dot(wrench.bottom(), p.w);
    const Vec6<double> force = now.leg_force.six();
    for (int i = 0; i < 6; ++i) rate[of_command] += (force[i] + now.stiffening[i]) * now.command[i].v;
  }

  MachineOnBaseInput in_;
  Machine<double> machine_;  // without gravity, which goes with the base's acceleration
  Vec6<double> L_0_;         // unstretched lengths with no command
  SixLegs legs_;
  Excitation base_, wrench_, command_;
  bool rotates_, friction_ = false, law_ = false;
  Pose<double> rest_;  // of the platform, base axes
  LegPlaces places_;   // what of them does not change
  Quaternion chart_;
  Mat3<double> R_chart_;
  Vec3<double> d_chart_;
  struct Chart {
    Vec3<Lanes> q, S;
    Lanes L{0.0};
  } chart_legs_[leg_groups];  // platform joints, legs and lengths where the chart was set
  PerLeg force_{};            // and leg forces there with no command
};

}  // namespace flexapod
