// One simulation from start to end: step size, corners of the excitations, samples, and what may stop it.
#pragma once

#include <atomic>

#include "model/modes.hpp"
#include "simulation/allowance.hpp"
#include "simulation/exponential_start.hpp"
#include "simulation/gauss.hpp"
#include "simulation/machine_on_base.hpp"
#include "simulation/pose_watch.hpp"
#include "simulation/task.hpp"

namespace flexapod {

using simulation_task::Options;
using simulation_task::Samples;

struct Counts {
  double accepted = 0, rejected = 0, evaluations = 0, exponential = 0;
};

class Simulation {
 public:
  using State = MachineOnBase::State;

  Simulation(const MachineOnBaseInput& input, const Excitation& base, const Excitation& wrench,
             const Excitation& command, const Options& options)
      : machine_(input, base, wrench, command),
        options_(options),
        size_(largest_radius(input.design)),
        watch_(size_, options.stop_at_singular) {
    const Modes modes =
        natural_modes(machine_.machine(), machine_.geometry(State{}), machine_.rest().R, Mat3<double>::identity());
    slowest_ = modes.omega[0], fastest_ = modes.omega[5];
    double spacing = std::numeric_limits<double>::infinity();
    for (const Excitation* e : {&base, &wrench, &command}) e->notes(corners_, spacing);
    // A step of 6 / omega is where the method stops being stable, and twelve stages see every piece of eight.
    max_step_ = std::min({options_.max_step, 6.0 / fastest_, 8.0 * spacing});
    // Beyond 1.5 / omega a polynomial through values one step apart may take an overtone for something slow.
    longest_exponential_ = std::min({options_.max_step, 1.5 / fastest_, 0.7 * spacing});
    if (!(fastest_ > 0)) options_.exponential = false;
    if (!(options_.atol > 0)) options_.atol = 1e-16 * size_;
    allowance_ = Allowance(options_.rtol, options_.atol, size_, slowest_, fastest_);
  }

  Outcome run(const Samples& samples, const std::atomic<bool>& stop, std::atomic<double>& progress) {
    samples_ = samples;
    const double end = samples.count ? samples.times[samples.count - 1] : 0.0;
    std::erase_if(corners_, [&](double t) { return !(t > 0.0 && t < end); });
    corners_.push_back(end);
    std::sort(corners_.begin(), corners_.end());
    State y = machine_.start();
    machine_.inside = 0.5 * corners_.front();
    watch_.begin(machine_, y), last_ = y, time_ = 0.0;
    double t = 0.0;
    next_step_ = first_step(end);
    sample_until(0.0, [&](double) { return y; });
    for (const double corner : corners_) {
      if (!(corner > t)) continue;
      machine_.inside = 0.5 * (t + corner);
      const Outcome outcome = go(t, corner, y, {stop, progress});
      if (outcome != Outcome::complete) return outcome;
      t = corner, y = rk_.y0;
    }
    progress = 1.0;
    return Outcome::complete;
  }

  double time() const { return time_; }  // reached
  const Counts& counts() const { return counts_; }
  /// The platform where the run ended, inertial axes.
  Motion<double> last() {
    Motion<double> platform, base;
    Vec6<double> leg_force;
    machine_.motions(time_, last_, platform, base, leg_force);
    return platform;
  }

 private:
  using Method = RungeKutta8<16>;
  // What steps cost, in evaluations: one of the Runge-Kutta method; an exponential one beside its evaluations, to begin with
  // them, and the works in one.
  static constexpr double runge_kutta_cost = 12.0, algebra = 0.3, beginning = 200.0, works_cost = 3.5;
  struct Reports {
    const std::atomic<bool>& stop;
    std::atomic<double>& progress;
  };

  auto rates() {
    return [this](int stage, double t, const State& y, State& rate) {
      counts_.evaluations += 1;
      machine_.rates(t, y, rate, stage == 0 || stage > 4);  // works take no part in stages 1 to 4
    };
  }

  double first_step(double end) const {
    const double step = fastest_ > 0 ? 0.1 / fastest_ : end;
    return std::min({step, 1e-3 * end, max_step_});
  }

  /// From t to the next corner: Runge-Kutta steps, and exponential ones where they are worth it.
  Outcome go(double t, double corner, const State& start, const Reports& reports) {
    const auto f = rates();
    rk_.begin(t, start, f);
    peaks_ = allowance_.after(peaks_, start, 0.0);
    start_.restart(), rejected_ = false;
    while (rk_.t < corner) {
      if (reports.stop.load(std::memory_order_relaxed)) return Outcome::stopped;
      if (no_more_steps()) return ended(Outcome::max_steps);
      if (options_.exponential) start_.gather(rk_.y0, rk_.rate(), next_step_, longest_exponential_, corner - rk_.t);
      const Outcome outcome = start_.ready() ? exponential(corner, reports) : runge_kutta(corner);
      if (outcome != Outcome::complete) return outcome;
      reports.progress.store(rk_.t / corners_.back(), std::memory_order_relaxed);
    }
    return Outcome::complete;
  }

  /// One step of the Runge-Kutta method, if its error allows it.
  Outcome runge_kutta(double corner) {
    const auto f = rates();
    const double left = corner - rk_.t, end = corners_.back();
    const bool last = next_step_ >= left * (1.0 - 1e-12);
    double h = last ? left : next_step_ > 0.5 * left ? 0.5 * left : next_step_;
    if (start_.gathering()) h = start_.spacing;
    if (!(h > 1e-14 * std::max(rk_.t, 1e-3 * end))) return ended(collapse());
    rk_.attempt(h, f);
    const double error = rk_.error(allowance_.at(allowance_.after(peaks_, rk_.y1, h)), MachineOnBase::mechanical);
    if (!(error <= 1.0)) {
      counts_.rejected += 1, rejected_ = true;
      start_.restart();
      next_step_ = h * (error > 1.0 ? std::max(0.2, 0.9 * std::pow(error, -0.125)) : 0.2);  // 0.2 too for NaN
      return Outcome::complete;
    }
    counts_.accepted += 1;
    rk_.accept(f);
    const double step_end = rk_.t + h;
    const auto inside = [&](double t) { return t == step_end ? rk_.y1 : rk_.inside(t, f); };
    const Outcome outcome = look(rk_.t, step_end, rk_.y1, inside, inside);
    if (outcome != Outcome::complete) return outcome;
    // Proportional-integral control (Hairer and Wanner II, IV.2): a fast mode's phase makes the error go up and down.
    const double growth = std::clamp(0.93 * std::pow(error, -0.7 / 8) * std::pow(last_error_, 0.4 / 8), 0.3, 6.0);
    last_error_ = std::max(error, 1e-4);
    const double proposed = h * (rejected_ ? std::min(1.0, growth) : growth);
    next_step_ = std::min(h < next_step_ ? std::max(proposed, next_step_) : proposed, max_step_);
    rejected_ = false;
    step_on(last && !start_.gathering() ? corner : rk_.t + h, f);
    return Outcome::complete;
  }

  /// Exponential steps until less than one is left to the corner, or they are no longer worth it.
  Outcome exponential(double corner, const Reports& reports) {
    const auto f = [this](double t, const State& y, State& rate) {
      counts_.evaluations += 1;
      machine_.rates(t, y, rate, false);
    };
    const Counts before = counts_;
    const double began = rk_.t;
    double unit[16];
    for (int i = 0; i < 16; ++i) unit[i] = 1e-5 * (i % 6 < 3 ? size_ : 1.0) * (i < 6 ? 1.0 : fastest_);
    adams_.linearise(rk_.t, rk_.y0, unit, f);
    Works works{rk_.t, rk_.y0};
    double shrinkage = 1.0;
    bool able = adams_.begin(rk_.t, start_.y, start_.rate, start_.spacing), recentred = false;
    while (able && !recentred && adams_.t + adams_.h * (1.0 + 1e-9) < corner && !no_more_steps()) {
      if (reports.stop.load(std::memory_order_relaxed)) return Outcome::stopped;
      adams_.attempt(f);
      const Peaks peaks = allowance_.after(peaks_, adams_.y1, adams_.h);
      const State allowed = allowance_.at(peaks);
      const double error = adams_.error(allowed);
      if (!(error <= 1.0)) {
        counts_.rejected += 1;
        shrinkage = adams_.shrinkage(error);
        able = adams_.shorten(error) && worth(2.0);
        continue;
      }
      counts_.accepted += 1, counts_.exponential += 1;
      const Outcome outcome = look_exponentially(works);
      if (outcome != Outcome::complete) return outcome;
      adams_.watch(error, allowed);
      adams_.advance();
      recentred = machine_.recentre(adams_.y0);
      time_ = adams_.t, last_ = adams_.y0, peaks_ = peaks;
      reports.progress.store(time_ / corners_.back(), std::memory_order_relaxed);
      able = adams_.adapt(longest_exponential_) && !adams_.stale() &&
             worth(counts_.exponential - before.exponential < 40 ? 2.0 : 1.0);
    }
    start_.restart();
    if (!able) {
      const double cost = beginning + (1.0 + algebra) * (counts_.evaluations - before.evaluations) +
                          (options_.works ? works_cost : 0.0) * (counts_.exponential - before.exponential);
      const bool paid = cost < runge_kutta_cost * (adams_.t - began) / next_step_;
      start_.give_up(paid, shrinkage * adams_.h / next_step_);
    }
    rk_.begin(adams_.t, with_works(works, adams_.t, adams_.y0), rates());
    if (recentred) watch_.begin(machine_, rk_.y0);
    return Outcome::complete;
  }

  /// Whether exponential steps of the present length are a good deal quicker, give or take `patience`.
  bool worth(double patience) const {
    const double cost = (adams_.twice() ? 2.0 : 1.0) + algebra + (options_.works ? works_cost : 0.0);
    return adams_.h * 0.75 * runge_kutta_cost * patience > next_step_ * cost;
  }

  /// The last instant to which works are known, and a state with them.
  struct Works {
    double t;
    State y;
  };
  /// The state at t, in the present exponential step, with the works until then.
  State with_works(Works& works, double t, State y) {
    if (options_.works && t > works.t) {
      gauss::each(gauss::points(2.0 * fastest_ * (t - works.t)), works.t, t, [&](double weight, double at) {
        State rate;
        const State between = adams_.inside(at, rate);
        machine_.powers(at, between, rate);
        for (int i = MachineOnBase::mechanical; i < 16; ++i) works.y[i] += weight * rate[i];
      });
      works.t = t;
    }
    std::copy(works.y.begin() + MachineOnBase::mechanical, works.y.end(), y.begin() + MachineOnBase::mechanical);
    return y;
  }
  Outcome look_exponentially(Works& works) {
    const double end = adams_.t + adams_.h;
    const auto inside = [&](double t) { return t == end ? adams_.y1 : adams_.inside(t); };
    const auto sampled = [&](double t) { return with_works(works, t, inside(t)); };
    const Outcome outcome = look(adams_.t, end, adams_.y1, inside, sampled);
    if (outcome == Outcome::complete) with_works(works, end, adams_.y1);
    return outcome;
  }

  /// Goes to the next step, with the error's scales and the chart brought up to date.
  template <class F> void step_on(double t, F&& f) {
    const double h = rk_.h;
    rk_.advance();
    rk_.t = t;  // exactly at a corner
    peaks_ = allowance_.after(peaks_, rk_.y0, h);
    const bool recentred = machine_.recentre(rk_.y0);
    time_ = t, last_ = rk_.y0;
    if (!recentred) return;
    rk_.begin(t, State(rk_.y0), f), watch_.begin(machine_, rk_.y0), start_.restart();
  }

  /// Takes the samples of the step just accepted, up to where something in it ends the run. `inside` gives the motion at an
  /// instant of it, `sampled` the works as well, at ascending instants.
  template <class F, class G> Outcome look(double from, double end, const State& y1, F&& inside, G&& sampled) {
    double until = end;
    const Outcome outcome = watch_.look(machine_, from, end, y1, inside, until);
    sample_until(until, sampled);
    if (outcome != Outcome::complete) time_ = until, last_ = inside(until);
    return outcome;
  }

  bool no_more_steps() const { return counts_.accepted + counts_.rejected >= options_.max_steps; }
  Outcome ended(Outcome why) {
    time_ = rk_.t, last_ = rk_.y0;
    return why;
  }
  /// Why steps have become too small.
  Outcome collapse() {
    State rate;
    machine_.rates(rk_.t, rk_.y0, rate, false);
    const Geometry<double> g = machine_.geometry(rk_.y0);
    for (int i = 0; i < 6; ++i) {
      const double L = norm(g.S[i]);
      if (L < 10.0 * PoseWatch::collapsed * size_) return Outcome::leg_collapsed;
      if (norm(cross(g.k[i], g.S[i])) < 1e-2 * L) return Outcome::joint_locked;
    }
    if (machine_.outside_law(rk_.t + 100.0 * next_step_)) return Outcome::outside_stiffness_law;
    const bool finite = std::all_of(rate.begin(), rate.end(), [](double x) { return std::isfinite(x); });
    return finite ? Outcome::step_collapse : Outcome::not_finite;
  }

  template <class G> void sample_until(double t, G&& state) {
    for (; next_sample_ < samples_.count && samples_.times[next_sample_] <= t; ++next_sample_) {
      const double at = samples_.times[next_sample_];
      const State y = state(at);
      const Vec6<double> x = machine_.displacement(at, y);
      std::copy_n(x.a, 6, samples_.displacement + 6 * next_sample_);
      std::copy_n(machine_.relative(y).a, 6, samples_.relative + 6 * next_sample_);
      std::copy_n(y.data() + MachineOnBase::mechanical, 4, samples_.work + 4 * next_sample_);
      if (!samples_.platform) continue;
      auto* platform = reinterpret_cast<Motion<double>*>(samples_.platform) + next_sample_;
      auto* base = reinterpret_cast<Motion<double>*>(samples_.base) + next_sample_;
      auto* leg_force = reinterpret_cast<Vec6<double>*>(samples_.leg_force) + next_sample_;
      machine_.motions(at, y, *platform, *base, *leg_force);
    }
  }

  MachineOnBase machine_;
  Options options_;
  Method rk_;
  ExponentialAdams adams_;
  ExponentialStart start_;
  bool rejected_ = false;
  Samples samples_{};
  Counts counts_;
  List<double> corners_;
  State last_{};
  double size_;
  PoseWatch watch_;
  double slowest_, fastest_;
  Allowance allowance_;
  double max_step_, longest_exponential_, next_step_ = 0, time_ = 0;
  Peaks peaks_;
  double last_error_ = 1.0;
  size_t next_sample_ = 0;
};

}  // namespace flexapod
