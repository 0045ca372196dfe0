// Taylor models: a function of u in [-1, 1]^n as a polynomial and a radius, for one box in each lane.
//
// A model stands for every function f with |f(u) - p(u)| <= r for all u. Numbers of the design that stray (docs/theory/
// certificates.md) are further variables from -1 to 1, of which the polynomial has the linear terms only. Each operation gives a model of its exact
// result: what the polynomial cannot hold and what rounding can have changed go into the radius. Rounding is bounded
// beforehand (docs/theory/certificates.md): no operation here adds more than 16 numbers to a coefficient, so `unit` times
// the sum of absolute coefficients is more than all roundings together, whatever the order of sums and with or without
// fused multiplication. There are no comparisons: a branch of a template on a value must not compile for this scalar.
#pragma once

#include <utility>

#include "certify/monomials.hpp"
#include "simd/pack.hpp"

namespace flexapod {

/// What makes models sound. Tests take other rules, and look whether somebody notices.
struct Sound {
  static constexpr bool product_remainder = true;  // products of an order that is cut off go into the radius
  static constexpr bool drop_squares = true;       // convex squares are not counted at vertices, where they are largest
  static constexpr bool other_pieces = true;       // pieces of a table that a box reaches into go into the radius
};

/// One lane of a pack.
template <class Lane> double lane_of(const Lane& pack, int lane) {
  double value;
  std::memcpy(&value, reinterpret_cast<const char*>(&pack) + lane * sizeof(double), sizeof(double));
  return value;
}
template <class Lane> void set_lane(Lane& pack, int lane, double value) {
  std::memcpy(reinterpret_cast<char*>(&pack) + lane * sizeof(double), &value, sizeof(double));
}

namespace rounding {
inline constexpr double unit = 0x1p-48;      // of the sum of absolute values that an operation adds up
inline constexpr double up = 1.0 + 0x1p-40;  // for bounds that are themselves rounded
inline constexpr double least = 1e-290;      // more than all underflows
}  // namespace rounding

/// Products of polynomials, whatever strays beside them.
template <class Lane, int n, int order> struct Polynomials {
  template <std::size_t... k>
  static FLEXAPOD_FLAT void multiply(Lane* to, const Lane* a, const Lane* b, std::index_sequence<k...>) {
    ((to[k] = coefficient<k>(a, b)), ...);
  }
  template <std::size_t... k>
  static FLEXAPOD_FLAT void multiply_add(Lane* to, const Lane& factor, const Lane* a, const Lane* b,
                                         std::index_sequence<k...>) {
    ((to[k] += factor * coefficient<k>(a, b)), ...);
  }

 private:
  template <int k> static FLEXAPOD_INLINE Lane coefficient(const Lane* a, const Lane* b) {
    constexpr const auto& products = monomial_products<n, order>;
    return [&]<std::size_t... p>(std::index_sequence<p...>) {
      return (... + (a[products.left[products.first[k] + p]] * b[products.right[products.first[k] + p]]));
    }(std::make_index_sequence<products.first[k + 1] - products.first[k]>{});
  }
};

template <class Lane, int n, int order, class Rules = Sound, int strays = 0> struct Taylor {
  static constexpr int terms = Monomials<n, order>::count;
  static constexpr int count = terms + strays;
  static constexpr int variables = n, highest = order;
  using Number = Lane;
  using Rule = Rules;

  Lane c[count];  // coefficients, in the order of Monomials, and those of the strays
  Lane r;         // radius

  Taylor() = default;
  Taylor(double value) : Taylor(Lane(value)) {}           // NOLINT: a constant is a model without error
  Taylor(const Lane& value) : c{}, r{} { c[0] = value; }  // NOLINT

  static Taylor variable(int i) {
    Taylor x(0.0);
    x.c[1 + i] = Lane(1.0);
    return x;
  }

  Taylor& operator+=(const Taylor& b) { return *this = *this + b; }
  Taylor& operator-=(const Taylor& b) { return *this = *this - b; }
  Taylor& operator*=(const Taylor& b) { return *this = *this * b; }

  friend FLEXAPOD_FLAT Taylor operator+(const Taylor& a, const Taylor& b) {
    Taylor s;
    for (int k = 0; k < count; ++k) s.c[k] = a.c[k] + b.c[k];
    return s.rounded(a.r + b.r);
  }
  friend FLEXAPOD_FLAT Taylor operator-(const Taylor& a, const Taylor& b) {
    Taylor s;
    for (int k = 0; k < count; ++k) s.c[k] = a.c[k] - b.c[k];
    return s.rounded(a.r + b.r);
  }
  friend FLEXAPOD_FLAT Taylor operator*(const Lane& a, const Taylor& b) {
    Taylor s;
    for (int k = 0; k < count; ++k) s.c[k] = a * b.c[k];
    return s.rounded(abs(a) * b.r);
  }
  friend Taylor operator-(Taylor a) {
    for (int k = 0; k < count; ++k) a.c[k] = -a.c[k];
    return a;
  }
  friend Taylor operator+(const Lane& a, Taylor b) {
    b.c[0] += a;
    b.r = (b.r + rounding::unit * abs(b.c[0])) * rounding::up + rounding::least;
    return b;
  }
  friend Taylor operator+(const Taylor& a, const Lane& b) { return b + a; }
  friend Taylor operator-(const Taylor& a, const Lane& b) { return -b + a; }
  friend Taylor operator-(const Lane& a, const Taylor& b) { return a + -b; }
  friend Taylor operator*(const Taylor& a, const Lane& b) { return b * a; }
  friend Taylor operator+(double a, const Taylor& b) { return Lane(a) + b; }
  friend Taylor operator+(const Taylor& a, double b) { return Lane(b) + a; }
  friend Taylor operator-(const Taylor& a, double b) { return Lane(-b) + a; }
  friend Taylor operator-(double a, const Taylor& b) { return Lane(a) + -b; }
  friend Taylor operator*(double a, const Taylor& b) { return Lane(a) * b; }
  friend Taylor operator*(const Taylor& a, double b) { return Lane(b) * a; }

  friend Taylor operator*(const Taylor& a, const Taylor& b) {
    Taylor product;
    const Norms na(a), nb(b);
    Polynomials<Lane, n, order>::multiply(product.c, a.c, b.c, std::make_index_sequence<terms>{});
    for (int k = terms; k < count; ++k) product.c[k] = a.c[0] * b.c[k] + a.c[k] * b.c[0];
    product.r = product_radius(a, na, b, nb);
    return product;
  }

  /// Sums of absolute coefficients by degree, of those of the strays, and of all.
  struct Norms {
    Lane of[order + 1], straying, all;

    explicit Norms(const Taylor& a) {
      all = straying = a.norm(terms, count);
      constexpr const auto& m = monomials<n, order>;
      for (int d = 0; d <= order; ++d) {
        of[d] = a.norm(m.first[d], m.first[d + 1]);
        all += of[d];
      }
    }
  };

  Lane norm(int first, int last) const {
    Lane sum(0.0);
    for (int k = first; k < last; ++k) sum += abs(c[k]);
    return sum;
  }
  /// The largest absolute value of all that is not constant.
  Lane variation() const {
    Lane sum(0.0);
    for (int k = 1; k < count; ++k) sum += abs(c[k]);
    return (sum + r) * rounding::up + rounding::least;
  }

  /// Adds factor a b, for constants.
  void add_product(const Lane& factor, const Taylor& a, const Norms& na, const Taylor& b, const Norms& nb) {
    Polynomials<Lane, n, order>::multiply_add(c, factor, a.c, b.c, std::make_index_sequence<terms>{});
    for (int k = terms; k < count; ++k) c[k] += factor * (a.c[0] * b.c[k] + a.c[k] * b.c[0]);
    Lane all(0.0);
    for (int k = 0; k < count; ++k) all += abs(c[k]);
    r = (r + abs(factor) * product_radius(a, na, b, nb) + rounding::unit * all) * rounding::up;
  }

  /// With a radius for all errors of its operands, and for the roundings of a last operation that gave the coefficients.
  FLEXAPOD_INLINE Taylor& rounded(const Lane& radius) {
    Lane sum(0.0);
    for (int k = 0; k < count; ++k) sum += abs(c[k]);
    r = (radius + rounding::unit * sum) * rounding::up + rounding::least;
    return *this;
  }

  /// The same with a lower order.
  template <int lower> Taylor<Lane, n, lower, Rules, strays> cut() const {
    Taylor<Lane, n, lower, Rules, strays> low;
    for (int k = 0; k < low.terms; ++k) low.c[k] = c[k];
    for (int k = 0; k < strays; ++k) low.c[low.terms + k] = c[terms + k];
    low.r = (r + norm(low.terms, terms)) * rounding::up;
    return low;
  }
  /// The same with the strays in the radius.
  Taylor<Lane, n, order, Rules> settled() const {
    Taylor<Lane, n, order, Rules> model;
    for (int k = 0; k < terms; ++k) model.c[k] = c[k];
    model.r = (r + norm(terms, count)) * rounding::up;
    return model;
  }

 private:
  static Lane product_radius(const Taylor& a, const Norms& na, const Taylor& b, const Norms& nb) {
    Lane cut(0.0);
    if constexpr (Rules::product_remainder) {
      for (int i = 1; i <= order; ++i)
        for (int j = order + 1 - i; j <= order; ++j) cut += na.of[i] * nb.of[j];
      if constexpr (strays > 0) {
        Lane vary_a(0.0), vary_b = nb.straying;
        for (int d = 1; d <= order; ++d) vary_a += na.of[d], vary_b += nb.of[d];
        cut += na.straying * vary_b + vary_a * nb.straying;
      }
    }
    const Lane errors = a.r * (nb.all + b.r) + na.all * b.r;
    return (errors + cut + rounding::unit * (na.all * nb.all)) * rounding::up + rounding::least;
  }
};

template <class Lane, int n, int order, class Rules, int strays>
struct is_scalar<Taylor<Lane, n, order, Rules, strays>> : std::true_type {};

}  // namespace flexapod
