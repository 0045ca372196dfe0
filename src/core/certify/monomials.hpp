// The monomials of n variables up to an order, and which pairs of them multiply to which: tables made by the compiler.
#pragma once

#include <array>

namespace flexapod {

inline constexpr int binomial(int n, int k) {
  int result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// Monomials by degree: 1, u_0 ... u_{n-1}, u_0 u_0, u_0 u_1 ... Those of a lower order come first in the same places.
template <int n, int order> struct Monomials {
  static constexpr int count = binomial(n + order, order);
  static constexpr int codes = [] {
    int all = 1;
    for (int v = 0; v < n; ++v) all *= order + 1;
    return all;
  }();

  int power[count][n] = {};
  int degree[count] = {};
  int first[order + 2] = {};  // of each degree
  int code[count] = {};       // its powers as digits: codes add as monomials multiply
  int of_code[codes] = {};

  constexpr Monomials() {
    int unit[n] = {}, last[count] = {}, made = 1;
    for (int v = 0, one = 1; v < n; ++v, one *= order + 1) unit[v] = one;
    for (int d = 1; d <= order; ++d) {
      first[d] = made;
      for (int m = first[d - 1]; m < first[d]; ++m)
        for (int v = last[m]; v < n; ++v) {
          for (int w = 0; w < n; ++w) power[made][w] = power[m][w];
          ++power[made][v];
          degree[made] = d, last[made] = v, code[made] = code[m] + unit[v];
          of_code[code[made]] = made;
          ++made;
        }
    }
    first[order + 1] = made;
  }

  /// The place of u_i, of u_i u_j, of u_i u_j u_k.
  constexpr int at(int i) const { return 1 + i; }
  constexpr int at(int i, int j) const { return of_code[code[at(i)] + code[at(j)]]; }
  constexpr int at(int i, int j, int k) const { return of_code[code[at(i)] + code[at(j)] + code[at(k)]]; }
};

template <int n, int order> inline constexpr Monomials<n, order> monomials{};

/// For each monomial k the pairs (left, right) whose product it is: entries first[k] up to first[k + 1].
template <int n, int order> struct MonomialProducts {
  static constexpr int count = Monomials<n, order>::count;
  static constexpr int pairs = binomial(2 * n + order, order);

  int first[count + 1] = {};
  int left[pairs] = {}, right[pairs] = {};

  constexpr MonomialProducts() {
    constexpr const Monomials<n, order>& m = monomials<n, order>;
    int place[count] = {};
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < m.first[order + 1 - m.degree[i]]; ++j) ++first[m.of_code[m.code[i] + m.code[j]] + 1];
    for (int k = 0; k < count; ++k) first[k + 1] += first[k], place[k] = first[k];
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < m.first[order + 1 - m.degree[i]]; ++j) {
        const int at = place[m.of_code[m.code[i] + m.code[j]]]++;
        left[at] = i, right[at] = j;
      }
  }
};

template <int n, int order> inline constexpr MonomialProducts<n, order> monomial_products{};

}  // namespace flexapod
