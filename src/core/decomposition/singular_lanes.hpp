// Singular values of 6 x m matrices in lanes: the bidiagonal form, and Jacobi rotations for lanes where it fails.
#pragma once

#include "decomposition/bidiagonal.hpp"
#include "decomposition/svd_jacobi.hpp"

namespace flexapod {

enum class Wanted { lowest, extremes, all };

/// Squared singular values, ascending, as shares of their sum. Those that are not wanted are not set.
template <class T> struct SingularSquares {
  T share[6], sum;
};

/// For the lanes `failed`.
template <class T, class Make>
FLEXAPOD_COLD void repeat_by_rotations(const Make& matrix, const mask_t<T>& failed, SingularSquares<T>& found) {
  T exact[6];
  squares_by_rotations(matrix(), exact);
  for (int i = 0; i < 6; ++i) found.share[i] = select(failed, exact[i] / found.sum, found.share[i]);
}

/// Of the matrix that `matrix` makes, which is asked again where the first way fails in a lane.
template <Wanted wanted, class T, class Make> FLEXAPOD_INLINE SingularSquares<T> singular_squares(const Make& matrix) {
  auto B = matrix();
  auto&& square = square_factor(B);
  SquaredBidiagonal<6, T> b = bidiagonalise(square);
  SingularSquares<T> found;
  found.sum = normalise(b);
  mask_t<T> failed;
  if constexpr (wanted == Wanted::all) {
    all_six(b, found.share, failed);
  } else {
    found.share[0] = lowest(b, T(0.0), failed);
    if constexpr (wanted == Wanted::extremes) {
      mask_t<T> open;
      found.share[5] = highest(b, open);
      failed = failed | open;
    }
  }
  failed = failed & (found.sum < 1e300);  // others hold no numbers
  if (any(failed)) [[unlikely]]
    repeat_by_rotations(matrix, failed, found);
  return found;
}

}  // namespace flexapod
