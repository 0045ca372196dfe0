// H x = b for lanes by Householder's orthogonal reduction: stable without exchanging rows, which lanes cannot.
#pragma once

#include "decomposition/reflection.hpp"

namespace flexapod {

template <int k, int m, class T> FLEXAPOD_INLINE void orthogonal_step(Mat6<T>& A, Vec6<T> (&b)[m], T (&diagonal)[6]) {
  const auto column = [&](int j) { return [&A, j](int i) -> T& { return A[k + i][j]; }; };
  const auto reflection = Reflection<T>::template of<6 - k>(column(k));
  diagonal[k] = -reflection.shift;
  for (int j = k + 1; j < 6; ++j) reflection.template apply<6 - k>(column(k), column(j));
  for (Vec6<T>& side : b) reflection.template apply<6 - k>(column(k), [&side](int i) -> T& { return side[k + i]; });
  if constexpr (k < 5) orthogonal_step<k + 1>(A, b, diagonal);
}

/// Overwrites A and the m right hand sides b with R and the solutions. `weak`: the least of R's diagonal beside the
/// largest.
template <int m, class T> FLEXAPOD_INLINE void solve_orthogonal(Mat6<T>& A, Vec6<T> (&b)[m], T& weak) {
  T diagonal[6];
  orthogonal_step<0>(A, b, diagonal);
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
