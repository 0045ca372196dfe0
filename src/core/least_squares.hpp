// H x = b for lanes by Householder's orthogonal reduction: stable without exchanging rows, which lanes cannot.
#pragma once

#include "bidiagonal.hpp"

namespace flexapod {

/// Overwrites A and the m right hand sides b (rows) with R and the solutions. `weak`: smallest part of R's diagonal
/// beside its largest.
template <int m, class T> void solve_orthogonal(Mat6<T>& A, Vec6<T> (&b)[m], T& weak) {
  T diagonal[6];
  for (int k = 0; k < 6; ++k) {
    T v[6], square;
    for (int i = 0; i < 6; ++i) v[i] = i < k ? T(0.0) : A[i][k];
    // The vector's leading part must come first: rotate it there.
    T x[6];
    for (int i = 0; i < 6; ++i) x[i] = k + i < 6 ? v[k + i] : T(0.0);
    const T lead = x[0], beta = householder(x, square);
    diagonal[k] = lead - x[0];
    const auto reflect = [&](auto&& element) {
      T sum(0.0);
      for (int i = k; i < 6; ++i) sum += x[i - k] * element(i);
      sum *= beta;
      for (int i = k; i < 6; ++i) element(i) -= sum * x[i - k];
    };
    for (int j = k + 1; j < 6; ++j) reflect([&](int i) -> T& { return A[i][j]; });
    for (Vec6<T>& side : b) reflect([&](int i) -> T& { return side[i]; });
  }
  T least = abs(diagonal[0]), most = least;
  for (int k = 0; k < 6; ++k) {
    least = min(least, abs(diagonal[k])), most = max(most, abs(diagonal[k]));
    diagonal[k] = 1.0 / diagonal[k];
  }
  weak = least / most;
  for (Vec6<T>& side : b)
    for (int i = 5; i >= 0; --i) {
      for (int j = i + 1; j < 6; ++j) side[i] -= A[i][j] * side[j];
      side[i] *= diagonal[i];
    }
}

}  // namespace flexapod
