// When exponential steps are tried: Runge-Kutta steps of one length gather the values that they begin with.
#pragma once

#include <algorithm>

#include "simulation/exponential_adams.hpp"

namespace flexapod {

class ExponentialStart {
 public:
  using State = ExponentialAdams::State;
  static constexpr int needed = ExponentialAdams::needed;

  State y[needed], rate[needed];  // one step apart
  double spacing = 0;             // that step

  /// Steps that go on from there are no successors of those before.
  void restart() { gathered_ = 0, wait_ = std::max(wait_, settling); }
  /// Takes the value at a step's start, where the next one has the length `step` and `left` is the time to the next corner.
  void gather(const State& now, const State& its_rate, double step, double longest, double left) {
    if (--wait_ > 0) return;
    if (gathered_ == 0) {
      spacing = std::min(share_ * step, longest);
      if (left < worthwhile * spacing) return;
    }
    y[gathered_] = now, rate[gathered_] = its_rate;
    ++gathered_;
  }
  bool gathering() const { return gathered_ > 0; }
  bool ready() const { return gathered_ == needed; }

  /// After exponential steps that could not go on. If they paid, at once again, about the present state; else ever later,
  /// but for a few trials with values closer to each other, where that is why. `share`: the step that would have been right
  /// over that of the Runge-Kutta method.
  void give_up(bool paid, double share) {
    if (paid) {
      share_ = std::clamp(share, closest, wide), rest_ = first_rest, wait_ = 1, trials_ = 0;
    } else if (share < share_ && share > closest && ++trials_ < 2) {
      share_ = share, wait_ = 1;
    } else {
      share_ = wide, wait_ = rest_, rest_ = std::min(2 * rest_, 1 << 20), trials_ = 0;
    }
  }

 private:
  static constexpr int settling = 12;         // steps before they are thought of
  static constexpr int first_rest = 400;      // steps before they are thought of again
  static constexpr double worthwhile = 60.0;  // steps to the next corner from which on they pay
  static constexpr double wide = 0.9, closest = 0.15;

  int gathered_ = 0, wait_ = 0, rest_ = first_rest, trials_ = 0;
  double share_ = wide;  // of the Runge-Kutta method's step
};

}  // namespace flexapod
