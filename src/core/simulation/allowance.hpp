// How large a step's error may be.
#pragma once

#include <algorithm>

#include "simulation/machine_on_base.hpp"

namespace flexapod {

/// Largest displacement and speed of the last few periods of the slowest mode, rotations counted at the platform's
/// size. Errors are measured against them, so that a vibration's passage through zero asks for nothing special.
struct Peaks {
  double displacement = 0, speed = 0;
};

class Allowance {
 public:
  using State = MachineOnBase::State;

  Allowance() = default;
  Allowance(double rtol, double atol, double size, double slowest, double fastest)
      : rtol_(rtol), atol_(atol), size_(size), slowest_(slowest), fastest_(std::max(fastest, 1.0)) {}

  /// The peaks when a step of h has led from them to y.
  Peaks after(const Peaks& peaks, const State& y, double h) {
    const auto length = [&](int i) { return std::sqrt(y[i] * y[i] + y[i + 1] * y[i + 1] + y[i + 2] * y[i + 2]); };
    if (h != h_) h_ = h, kept_ = std::exp(-0.2 * slowest_ * h);
    return {std::max({kept_ * peaks.displacement, length(0), size_ * length(3)}),
            std::max({kept_ * peaks.speed, length(6), size_ * length(9)})};
  }
  /// Of each of the state's numbers; 1 for the works.
  State at(const Peaks& peaks) const {
    const double d = atol_ + rtol_ * peaks.displacement, v = atol_ * fastest_ + rtol_ * peaks.speed;
    State scale;
    scale.fill(1.0);
    for (int i = 0; i < 3; ++i) scale[i] = d, scale[3 + i] = d / size_, scale[6 + i] = v, scale[9 + i] = v / size_;
    return scale;
  }

 private:
  double rtol_ = 0, atol_ = 0, size_ = 1, slowest_ = 0, fastest_ = 1;
  double h_ = 0, kept_ = 1;  // of the last step, and what it leaves of the peaks
};

}  // namespace flexapod
