// A double that counts its arithmetic, to know the work that a pose takes.
#pragma once

#include <cmath>
#include <cstddef>

#include "numbers/scalar.hpp"

namespace flexapod {

/// One for each sum, difference, product, quotient and square root; none for signs, comparisons and choices.
struct Counted {
  static constexpr int lanes = 1, parts = 1;
  using Part = Counted;
  using Wide = Counted;
  static inline thread_local long count = 0;
  double v{};

  Counted() = default;
  Counted(double x) : v(x) {}  // NOLINT: a number
  static Counted load(const double* p) { return *p; }
  static Counted gather(const double* p, std::size_t) { return *p; }
  void store(double* p) const { *p = v; }
  void set_part(int, const Counted& part) { *this = part; }
  void set_share(int, const Counted& share) { *this = share; }
  template <class> Counted share(int) const { return *this; }

  Counted& operator+=(const Counted& b) { return *this = *this + b; }
  Counted& operator-=(const Counted& b) { return *this = *this - b; }
  Counted& operator*=(const Counted& b) { return *this = *this * b; }
  friend Counted operator+(Counted a, Counted b) { return counted(a.v + b.v); }
  friend Counted operator-(Counted a, Counted b) { return counted(a.v - b.v); }
  friend Counted operator*(Counted a, Counted b) { return counted(a.v * b.v); }
  friend Counted operator/(Counted a, Counted b) { return counted(a.v / b.v); }
  friend Counted operator-(Counted a) { return -a.v; }
  friend bool operator<(Counted a, Counted b) { return a.v < b.v; }
  friend bool operator>(Counted a, Counted b) { return a.v > b.v; }
  friend bool operator<=(Counted a, Counted b) { return a.v <= b.v; }
  friend bool operator>=(Counted a, Counted b) { return a.v >= b.v; }

  static Counted counted(double x) {
    ++count;
    return x;
  }
};

template <> struct is_scalar<Counted> : std::true_type {};

inline Counted sqrt(Counted a) { return Counted::counted(std::sqrt(a.v)); }
inline Counted rsqrt(Counted a) { return 1.0 / sqrt(a); }
inline Counted abs(Counted a) { return std::abs(a.v); }
inline Counted select(bool take_a, Counted a, Counted b) { return take_a ? a : b; }

}  // namespace flexapod
