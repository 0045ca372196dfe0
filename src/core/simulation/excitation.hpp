// What drives the machine: six functions of time with exact first and second derivatives, sums of a few kinds of terms.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "model/rotation.hpp"
#include "simd/isa_vector.hpp"

namespace flexapod {

/// A function's value and first two time derivatives at one instant.
struct Jet {
  double x = 0, v = 0, a = 0;

  Jet& operator+=(const Jet& b) {
    x += b.x, v += b.v, a += b.a;
    return *this;
  }
};
inline Jet operator*(const Jet& f, const Jet& g) {
  return {f.x * g.x, f.v * g.x + f.x * g.v, f.a * g.x + 2.0 * f.v * g.v + f.x * g.a};
}

/// From 0 to 1 over [0, 1] with three derivatives zero at both ends, stretched to the duration T.
inline Jet smooth_rise(double t, double T) {
  if (t >= T) return {1.0, 0.0, 0.0};
  if (t <= 0.0) return {};
  const double s = t / T, s2 = s * s, r = 1.0 - s;
  return {s2 * s2 * (35.0 + s * (-84.0 + s * (70.0 - 20.0 * s))), 140.0 * s2 * s * r * r * r / T,
          420.0 * s2 * r * r * (1.0 - 2.0 * s) / (T * T)};
}

enum class TermKind { sinusoids, chirp, pieces };

/// A term in numbers: channel, kind, start, rise, stop, fall, and the kind's own numbers (see the functions below).
struct Term {
  static constexpr int header = 7;
  int channel;
  TermKind kind;
  double start, rise, stop, fall;
  const double* data;
  size_t size;
};

/// Sum of A sin(omega t + phi) over triples A, omega, phi. Long sums are expanded in a Taylor series about the middle of
/// an interval of the fastest one's phase, and summed anew only on leaving it.
class Sinusoids {
 public:
  Sinusoids(const double* triples, size_t count) : triples_(triples), count_(count) {
    for (size_t i = 0; i < count; ++i) omega_ = std::max(omega_, std::abs(triples[3 * i + 1]));
  }
  Jet at(double t) {
    if (count_ <= direct || !(omega_ > 0)) return summed(t);
    if (!(std::abs(t - center_) * omega_ <= 1.0)) expand(t);
    const double s = (t - center_) * omega_;
    double x = 0, v = 0, a = 0;
    for (int k = order; k >= 0; --k) {
      a = a * s + 2.0 * v, v = v * s + x, x = x * s + c_[k];
    }
    return {x, omega_ * v, omega_ * omega_ * a};
  }

 private:
  static constexpr size_t direct = 4;  // terms that are quicker summed than expanded
  static constexpr int order = 18;     // 1 / 17! is what it leaves in the second derivative: 3e-15

  Jet summed(double t) const {
    Jet sum;
    for (size_t i = 0; i < count_; ++i) {
      const double A = triples_[3 * i], w = triples_[3 * i + 1], phase = w * t + triples_[3 * i + 2];
      const double sine = A * std::sin(phase);
      sum += {sine, A * w * std::cos(phase), -w * w * sine};
    }
    return sum;
  }
  void expand(double t) {
    center_ = t + 0.9 / omega_;  // integration goes forward, with stages that may look back a little
    std::fill_n(c_, order + 1, 0.0);
    for (size_t i = 0; i < count_; ++i) {
      const double w = triples_[3 * i + 1], phase = w * center_ + triples_[3 * i + 2], r = w / omega_;
      const double sine = triples_[3 * i] * std::sin(phase), cosine = triples_[3 * i] * std::cos(phase);
      double power = 1.0;
      for (int k = 0; k <= order; ++k) {
        c_[k] += power * (k % 2 ? cosine : sine) * (k % 4 < 2 ? 1.0 : -1.0);
        power *= r / (k + 1);
      }
    }
  }

  const double* triples_;
  size_t count_;
  double omega_ = 0, center_ = std::numeric_limits<double>::quiet_NaN();
  double c_[order + 1];
};

/// A swept sine. Numbers: amplitude, omega_0, omega_1, T, logarithmic (0 or 1), power n: the amplitude goes with
/// (omega_0 / omega)^n, so that n = 2 holds the acceleration. When it is over, after T, it stays at omega_1.
inline Jet chirp(const double* p, double t, bool over) {
  const double A = p[0], w0 = p[1], w1 = p[2], T = p[3], n = p[5];
  Jet omega, phase;  // the phase's second derivative is omega's first
  double jerk = 0;   // omega's second derivative
  if (p[4] != 0.0) {
    const double rate = std::log(w1 / w0) / T, s = over ? T : t, w = w0 * std::exp(rate * s);
    omega = {w, rate * w, 0.0}, jerk = rate * rate * w;
    phase.x = rate != 0.0 ? (w - w0) / rate : w0 * s;
  } else {
    const double rate = (w1 - w0) / T, s = over ? T : t;
    omega = {w0 + rate * s, rate, 0.0};
    phase.x = s * (w0 + 0.5 * rate * s);
  }
  if (over) omega = {w1, 0.0, 0.0}, jerk = 0.0, phase.x += w1 * (t - T);
  const double scale = A * std::pow(w0 / omega.x, n), q = omega.v / omega.x;
  const Jet amplitude{scale, -n * scale * q, scale * (n * (n + 1.0) * q * q - n * jerk / omega.x)};
  const double sine = std::sin(phase.x), cosine = std::cos(phase.x);
  return amplitude * Jet{sine, omega.x * cosine, omega.v * cosine - omega.x * omega.x * sine};
}

/// From its first instant: coefficients of powers of the time since then, and sine * sin(omega time).
struct Piece {
  double start, coefficients[8], sine, omega;
};
static_assert(sizeof(Piece) == 11 * sizeof(double));

/// Piecewise polynomials with a sine each. Numbers: whether the pieces meet with a corner (0 or 1), then the pieces. The
/// last one goes on for ever; before the first there is nothing.
class Pieces {
 public:
  Pieces(const double* data, size_t size)
      : pieces_(reinterpret_cast<const Piece*>(data + 1)),
        count_((size - 1) * sizeof(double) / sizeof(Piece)),
        corners_(data[0] != 0.0) {}

  /// `inside` is an instant of the step that t belongs to: at a corner it tells which piece is meant.
  Jet at(double t, double inside) {
    const double choice = corners_ ? inside : t;
    if (choice < pieces_[0].start) return {};
    while (here_ > 0 && choice < pieces_[here_].start) --here_;
    while (here_ + 1 < count_ && choice >= pieces_[here_ + 1].start) ++here_;
    const Piece& p = pieces_[here_];
    const double s = t - p.start, B = p.sine, w = p.omega;
    double x = 0, v = 0, a = 0;
    for (int k = 7; k >= 0; --k) a = a * s + 2.0 * v, v = v * s + x, x = x * s + p.coefficients[k];
    if (B != 0.0) {
      const double sine = B * std::sin(w * s);
      x += sine, v += B * w * std::cos(w * s), a -= w * w * sine;
    }
    return {x, v, a};
  }
  /// Corners; and the least time between pieces that meet smoothly, which a step should not pass by unseen.
  void notes(double start, List<double>& corners, double& spacing) const {
    for (size_t i = 0; i < count_; ++i)
      if (corners_ || i == 0) corners.push_back(start + pieces_[i].start);
    if (!corners_ && count_ > 1) {
      const double span = pieces_[count_ - 1].start - pieces_[0].start;
      spacing = std::min(spacing, span / static_cast<double>(count_ - 1));
    }
  }

 private:
  const Piece* pieces_;
  size_t count_, here_ = 0;
  bool corners_;
};

/// Six channels. One of these belongs to one simulation: it remembers where in its series it is.
class Excitation {
 public:
  /// Terms one after another, each as in `Term` with the count of its own numbers last in its header.
  Excitation(const double* numbers, size_t size) {
    for (size_t at = 0; at < size;) {
      if (size - at < Term::header) throw std::invalid_argument("excitation: a term's header is cut off");
      const double* h = numbers + at;
      const auto count = static_cast<size_t>(h[6]);
      if (size - at - Term::header < count || !(h[0] >= 0 && h[0] < 6))
        throw std::invalid_argument("excitation: a term's numbers are cut off");
      terms_.push_back({static_cast<int>(h[0]), static_cast<TermKind>(static_cast<int>(h[1])), h[2], h[3], h[4], h[5],
                        h + Term::header, count});
      const Term& term = terms_.back();
      sums_.emplace_back(term.data, term.kind == TermKind::sinusoids ? count / 3 : 0);
      pieces_.emplace_back(term.data, term.kind == TermKind::pieces ? count : 1);
      at += Term::header + count;
    }
  }
  bool empty() const { return terms_.empty(); }
  bool uses(int first, int last) const {
    return std::any_of(terms_.begin(), terms_.end(),
                       [&](const Term& t) { return t.channel >= first && t.channel < last; });
  }

  /// All channels at t, an instant of a step that has `inside` between its ends.
  void at(double t, double inside, Jet (&channel)[6]) {
    std::fill_n(channel, 6, Jet{});
    for (size_t i = 0; i < terms_.size(); ++i) {
      const Term& term = terms_[i];
      if (inside < term.start || inside >= term.stop + term.fall) continue;
      const double s = t - term.start;
      Jet value = term.kind == TermKind::sinusoids ? sums_[i].at(s)
                  : term.kind == TermKind::chirp   ? chirp(term.data, s, inside - term.start > term.data[3])
                                                   : pieces_[i].at(s, inside - term.start);
      if (inside < term.start + term.rise) value = value * smooth_rise(s, term.rise);
      if (inside > term.stop) {
        const Jet fall = smooth_rise(t - term.stop, term.fall);
        value = value * Jet{1.0 - fall.x, -fall.v, -fall.a};
      }
      channel[term.channel] += value;
    }
  }

  /// Instants at which a derivative may jump, and the least spacing of sampled series.
  void notes(List<double>& corners, double& spacing) const {
    for (size_t i = 0; i < terms_.size(); ++i) {
      const Term& term = terms_[i];
      for (const double t : {term.start, term.start + term.rise, term.stop, term.stop + term.fall})
        corners.push_back(t);
      if (term.kind == TermKind::chirp) corners.push_back(term.start + term.data[3]);
      if (term.kind == TermKind::pieces) pieces_[i].notes(term.start, corners, spacing);
    }
  }

 private:
  List<Term> terms_;
  List<Sinusoids> sums_;
  List<Pieces> pieces_;
};

/// How the base moves from its pose at rest.
struct BaseMotion {
  Motion<double> motion;  // inertial axes
  Vec3<double> travel;    // of its reference point from rest, inertial axes
  Quaternion turn;        // from rest, inertial axes: R = turn R_rest

  BaseMotion(const Pose<double>& rest, const Jet (&channel)[6], bool rotates, bool roll_pitch_yaw) {
    const auto three = [&](int first, double Jet::* part) {
      return Vec3<double>(channel[first].*part, channel[first + 1].*part, channel[first + 2].*part);
    };
    travel = three(0, &Jet::x);
    motion.pose = {rest.t + travel, rest.R};
    motion.v = three(0, &Jet::v), motion.a = three(0, &Jet::a);
    if (!rotates) return;
    const Vec3<double> e = three(3, &Jet::x), e1 = three(3, &Jet::v), e2 = three(3, &Jet::a);
    if (roll_pitch_yaw) {
      const RollPitchYaw rpy(e, e1, e2);
      turn = rpy.turn, motion.w = rpy.w, motion.alpha = rpy.alpha;
    } else {
      const RotationVectorRates rates(e, e1, e2);
      turn = Quaternion::exp(e), motion.w = rates.w, motion.alpha = rates.alpha;
    }
    motion.pose.R = turn.matrix() * rest.R;
  }
};

}  // namespace flexapod
