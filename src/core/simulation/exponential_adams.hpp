// Exponential Adams steps for y' = f(t, y) = A y + g(t, y), A constant: the linear part is solved exactly and g is replaced by the
// polynomial through its last values, which are one step apart (J. Certaine 1960; S. P. Norsett 1969; M. Hochbruck,
// A. Ostermann, Acta Numerica 19 (2010) 209-286, Section 2.5). With backward differences G_j of g at t_n,
//
//   g(t_n + theta h) ~ sum_{j<k} c_j(theta) G_j,   c_j(theta) = theta (theta + 1) ... (theta + j - 1) / j!,
//   y_p = E y_n + sum_{j<k} B_j G_j,               E = exp(h A),  B_j = h int_0^1 exp((1 - theta) h A) c_j(theta) dtheta,
//   y_{n+1} = y_p + B_k d,                         d = g(t_n + h, y_p) - sum_{j<k} G_j.
//
// g is evaluated at y_p, and at y_{n+1} too where it depends so much on y that one evaluation would not be stable. The
// matrices serve as long as step and A stay.
#pragma once

#include <array>

#include "simd/isa_vector.hpp"
#include "simulation/propagator.hpp"

namespace flexapod {

/// Steps of one length, which can be changed, and of an order that goes with the accuracy. F is f(t, y, rate).
class ExponentialAdams {
 public:
  using State = std::array<double, 16>;
  static constexpr int needed = 11;                  // values of f, one step apart, to begin with
  static constexpr double rung = 1.189207115002721;  // step lengths are these powers of each other: 2^(1/4)

  double t = 0, h = 0;  // the present step's start and length
  State y0{}, y1{};     // at its two ends

  /// A by central differences about y. `unit`: sizes of its numbers at which f is still nearly linear.
  template <class F> void linearise(double at, const State& y, const double (&unit)[16], F&& f) {
    std::copy(unit, unit + 16, unit_);
    for (int c = 0; c < 12; ++c) {
      State low = y, high = y, f_low, f_high;
      low[c] -= unit[c], high[c] += unit[c];
      f(at, low, f_low), f(at, high, f_high);
      double column[16] = {};
      for (int i = 3; i < 12; ++i) column[i] = (f_high[i] - f_low[i]) / (high[c] - low[c]);
      if (c >= 6 && c < 9) column[c - 6] = 1.0;  // displacement' = velocity
      A_[c] = exponential::Twelve::load(column);
    }
    used_ = 0, longest_ = std::numeric_limits<double>::infinity();
    propagators_.resize(kept);
  }
  /// Begins at the last of `needed` states with their rates, `step` apart. False where the step is too long for A.
  bool begin(double start, const State (&y)[needed], const State (&rate)[needed], double step) {
    t = start, y0 = y[needed - 1];
    filled_ = 0, since_look_ = 0, feedback_ = 0, twice_ = true;
    for (int i = 0; i < needed; ++i) {
      set_next(y[i], rate[i]);
      commit();
    }
    order_ = needed - 2;
    dense_ = false;
    return set_step(step);
  }
  /// Works out y1.
  template <class F> void attempt(F&& f) {
    const exponential::Propagator& P = *propagator_;
    exponential::Sums sums;
    sums.add(P.E, y0.data());
    for (int j = 0; j < order_; ++j) sums.add(P.B[j], G_[j] + 3);
    const exponential::Twelve predicted = sums.total();
    State y{}, rate;
    predicted.store(y.data());
    f(t + h, y, rate);
    set_next(y, rate);
    const exponential::Twelve correction = corrected(next_[order_]);
    y1 = y0;
    (predicted + correction).store(y1.data());
    dense_ = false;
    if (!twice_ && ++since_look_ < window) return;
    since_look_ = 0;
    f(t + h, y1, rate);
    set_next(y1, rate);
    feedback_ = feedback(correction, corrected(next_[order_]) - correction);
    twice_ = feedback_ > once_allowed();
  }
  /// Whether g goes so much with y that steps of this kind would not be stable: A is out of date.
  bool stale() const { return feedback_ > 0.015; }
  bool twice() const { return twice_; }
  /// Root mean square of the step's error, each number over its scale.
  double error(const State& scale) const { return error_of(order_, scale); }
  void advance() { t += h, y0 = y1, commit(), dense_ = false; }

  /// To be called with the error of every step accepted, before `advance`; afterwards, `adapt` chooses order and step.
  void watch(double error, const State& scale) {
    worst_[1] = std::max(worst_[1], error);
    if (++watched_ % 4) return;
    const bool lower = order_ > exponential::min_order;
    const bool higher = order_ < exponential::max_order && filled_ > order_ + 1;
    constexpr double never = std::numeric_limits<double>::infinity();
    worst_[0] = lower ? std::max(worst_[0], error_of(order_ - 1, scale)) : never;
    worst_[2] = higher ? std::max(worst_[2], error_of(order_ + 1, scale)) : never;
  }
  /// False where the step can become no shorter.
  bool adapt(double longest) {
    if (watched_ < window && worst_[1] < 0.7) return true;
    int best = 1;
    double growth[3];
    for (int i = 0; i < 3; ++i) growth[i] = grows(order_ - 1 + i, worst_[i]);
    if (watched_ >= 4)
      for (const int i : {0, 2})
        if (growth[i] > 1.02 * growth[best]) best = i;
    order_ += best - 1;
    const double rungs = std::floor(std::log(growth[best]) / std::log(rung) + 0.05);
    const double before = h;
    if (change_step(std::min({h * std::pow(rung, std::clamp(rungs, -4.0, 2.0)), longest, longest_}))) return true;
    longest_ = before;
    return h > before && change_step(before);
  }
  /// By how much a step that was not accurate enough is to be shorter; 0 where that cannot be said.
  double shrinkage(double error) const { return std::isfinite(error) ? grows(order_, error) : 0.0; }
  /// False where the error is so large that what g is between its values, from which it goes on, is not known well enough.
  bool shorten(double error) {
    const double rungs = std::floor(std::log(shrinkage(error)) / std::log(rung));
    return error <= 2.0 && change_step(h * std::pow(rung, std::min(rungs, -1.0)));
  }

  /// The solution inside the step worked out last.
  State inside(double time) {
    using exponential::Twelve;
    if (!dense_) prepare();
    const double theta = (time - t) / h;
    Twelve sum = Twelve::load(taylor_[terms_]);
    for (int m = terms_ - 1; m >= 0; --m) {
      Twelve next = Twelve::load(taylor_[m]);
      next.add(sum, theta);
      sum = next;
    }
    State y = y0;
    sum.store(y.data());
    return y;
  }
  /// And its rates.
  State inside(double time, State& rate) {
    using exponential::Twelve;
    if (!dense_) prepare();
    const double theta = (time - t) / h;
    Twelve sum = Twelve::zero(), slope = Twelve::zero();
    for (int m = terms_; m >= 0; --m) {
      Twelve next = sum, next_sum = Twelve::load(taylor_[m]);
      next.add(slope, theta), next_sum.add(sum, theta);
      slope = next, sum = next_sum;
    }
    State y = y0;
    sum.store(y.data());
    Twelve rates = Twelve::zero();
    rates.add(slope, 1.0 / h);
    rates.store(rate.data());
    return y;
  }
  int order() const { return order_; }

 private:
  static constexpr int window = 24;       // steps between looks at order and step
  static constexpr double aim = 0.25;     // of the error allowed
  static constexpr double caution = 4.0;  // errors of motions far from linear add up, as those of oscillations do not
  static constexpr int kept = 6;          // propagators

  static double grows(int order, double error) { return std::pow(aim / std::max(error, 1e-12), 1.0 / (order + 2)); }
  exponential::Twelve corrected(const double* d) const {
    exponential::Sums sums;
    sums.add(propagator_->B[order_], d + 3);
    return sums.total();
  }
  /// How far a change of y comes back as another by way of g.
  double feedback(const exponential::Twelve& change, const exponential::Twelve& answer) const {
    double y[16], a[16], size = 0, square = 0, back = 0;
    change.store(y), answer.store(a);
    for (int i = 0; i < 12; ++i) {
      const double per = 1.0 / unit_[i];
      size += y1[i] * per * y1[i] * per, square += y[i] * per * y[i] * per, back += a[i] * per * a[i] * per;
    }
    return square > 1e-24 * size ? std::sqrt(back / square) : 0.0;  // below that it is rounding
  }
  /// The feedback up to which one evaluation a step is stable: half of what roots of the characteristic polynomials of
  /// y' = i mu y give, which falls by about 0.54 from order to order.
  double once_allowed() const { return 0.02 * std::pow(0.54, order_ - 4); }

  /// Differences of g with the value that goes with y and f = rate.
  void set_next(const State& y, const State& rate) {
    exponential::Sums linear;
    linear.add(A_, y.data());
    exponential::Twelve d = exponential::Twelve::load(rate.data()) - linear.total();
    d.store(next_[0]);
    for (int i = 0; i < 3; ++i) next_[0][i] = 0.0;
    for (int j = 0; j < filled_; ++j) {
      d = exponential::Twelve::load(next_[j]) - exponential::Twelve::load(G_[j]);
      d.store(next_[j + 1]);
    }
  }
  void commit() {
    filled_ = std::min(filled_ + 1, exponential::differences - 1);
    std::copy(&next_[0][0], &next_[filled_][0], &G_[0][0]);
  }
  /// Of the corrector of that order.
  double error_of(int order, const State& scale) const {
    exponential::Sums sums;
    const auto &low = propagator_->B[order], &high = propagator_->B[order + 1];
    const double* d = next_[order + 1] + 3;
    for (int c = 0; c < exponential::Propagator::driven; ++c) sums.part[c % 3].add(high[c] - low[c], d[c]);
    const exponential::Twelve e = sums.total(), allowed = exponential::Twelve::load(scale.data());
    exponential::Twelve::Lanes square(0.0);
    for (int p = 0; p < exponential::Twelve::parts; ++p) {
      const auto ratio = e.part[p] / allowed.part[p];
      square += ratio * ratio;
    }
    return (twice_ ? caution : 1.0) * std::sqrt(sum(square) / 12);
  }
  bool change_step(double step) {
    worst_[0] = worst_[1] = worst_[2] = 0.0, watched_ = 0;
    if (step == h) return true;
    rescale(step / h);
    return set_step(step);
  }
  bool set_step(double step) {
    worst_[0] = worst_[1] = worst_[2] = 0.0, watched_ = 0;
    h = step;
    for (int i = 0; i < used_; ++i)
      if (std::abs(propagators_[i].h - step) < 1e-9 * step) {
        propagator_ = &propagators_[i], h = propagator_->h;
        return true;
      }
    if (used_ == kept) used_ = 0;  // begin anew: which are dropped matters little
    propagator_ = &propagators_[used_];
    if (!propagators_[used_].set(A_, step, unit_)) return false;
    ++used_;
    return true;
  }
  /// Differences of the same polynomial, of the degree of the order, between values `ratio` as far apart.
  void rescale(double ratio) {
    constexpr int most = exponential::differences;
    const int count = std::min(order_ + 1, filled_);
    double value[most][16] = {};
    for (int l = 0; l < count; ++l) {
      double c = 1.0;
      for (int j = 0; j < count; ++j) {
        for (int i = 3; i < 12; ++i) value[l][i] += c * G_[j][i];
        c *= (j - l * ratio) / (j + 1);
      }
    }
    for (int j = 0; j < count; ++j) {
      std::copy(value[0], value[0] + 16, G_[j]);
      for (int l = 0; l + 1 < count - j; ++l)
        for (int i = 3; i < 12; ++i) value[l][i] -= value[l + 1][i];
    }
    filled_ = count;
    order_ = std::min(order_, filled_ - 1);
  }
  /// The step's solution as a series in theta.
  void prepare() {
    using exponential::Twelve;
    terms_ = std::max(propagator_->terms, order_ + 1);
    for (int m = 0; m <= order_; ++m) {
      Twelve q = Twelve::zero();
      for (int j = m; j < order_; ++j) q.add(Twelve::load(G_[j]), exponential::weights.c[j][m]);
      q.add(Twelve::load(next_[order_]), exponential::weights.c[order_][m]);
      q.store(taylor_[m + 1]);
    }
    std::copy_n(y0.data(), 16, taylor_[0]);
    for (int m = 0; m < terms_; ++m) {
      exponential::Sums sums;
      sums.add(A_, taylor_[m]);
      Twelve rate = sums.total(), term = Twelve::zero();
      if (m <= order_) rate = rate + Twelve::load(taylor_[m + 1]);
      term.add(rate, h / (m + 1));
      term.store(taylor_[m + 1]);
    }
    dense_ = true;
  }

  exponential::Twelve A_[12];
  double unit_[16];
  List<exponential::Propagator> propagators_;
  exponential::Propagator* propagator_ = nullptr;
  int used_ = 0, order_ = 0, filled_ = 0, terms_ = 0, watched_ = 0;
  alignas(64) double G_[exponential::differences + 1][16] = {}, next_[exponential::differences + 1][16] = {};
  alignas(64) double taylor_[exponential::max_terms + 2][16];
  double worst_[3] = {};
  bool dense_ = false, twice_ = true;  // whether g is evaluated at y1 too
  int since_look_ = 0;
  double feedback_ = 0, longest_ = 0;  // and the step beyond which the series of the linear part does not converge
};

}  // namespace flexapod
