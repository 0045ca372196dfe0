// Singular values of 6 x m matrices in lanes: the bidiagonal form, and Jacobi rotations for lanes where it fails.
#pragma once

#include <limits>

#include "decomposition/bidiagonal.hpp"
#include "decomposition/svd_jacobi.hpp"

namespace flexapod {

enum class Wanted { lowest, extremes, all };

/// Squared singular values, ascending, as shares of their sum. Those that are not wanted are not set.
template <class T> struct SingularSquares {
  T share[6], sum;
};

/// The second half of the work. In lanes where it fails, the lowest share is NaN.
template <class T> FLEXAPOD_INLINE SingularSquares<T> finished(Wanted wanted, HalfBidiagonal<T>& half) {
  SquaredBidiagonal<6, T> b = half.finish();
  SingularSquares<T> found;
  found.sum = normalise(b);
  mask_t<T> failed;
  found.share[0] = lowest(b, T(0.0), failed);
  if (wanted == Wanted::all) {
    other_five(b, found.share, failed);
  } else if (wanted == Wanted::extremes) {
    mask_t<T> open;
    found.share[5] = highest(b, open);
    failed = failed | open;
  }
  found.share[0] = select(failed, T(std::numeric_limits<double>::quiet_NaN()), found.share[0]);
  return found;
}

template <class T, class Make>
FLEXAPOD_COLD void repeat_by_rotations(const Make& matrix, const mask_t<T>& failed, SingularSquares<T>& found) {
  T exact[6];
  squares_by_rotations(matrix(), exact);
  for (int i = 0; i < 6; ++i) found.share[i] = select(failed, exact[i] / found.sum, found.share[i]);
}

/// Where `finished` failed, by rotations of the matrix, which `matrix` makes anew.
template <class T, class Make> FLEXAPOD_INLINE void repair(const Make& matrix, SingularSquares<T>& found) {
  const auto failed = (!(found.share[0] >= 0.0)) & (found.sum < 1e300);  // others hold no numbers
  if (any(failed)) [[unlikely]]
    repeat_by_rotations(matrix, failed, found);
}

/// Of the matrix that `matrix` makes, which is asked again where the first way fails in a lane.
template <Wanted wanted, class T, class Make> FLEXAPOD_INLINE SingularSquares<T> singular_squares(const Make& matrix) {
  auto B = matrix();
  auto&& square = square_factor(B);
  HalfBidiagonal<T> half(square);
  SingularSquares<T> found = finished(wanted, half);
  repair(matrix, found);
  return found;
}

/// The two halves of the work for lanes, which are compiled once for all that make matrices.
template <class T> FLEXAPOD_APART void begin(Mat6<T>& square, HalfBidiagonal<T>& half) {
  half = HalfBidiagonal<T>(square);
}
template <class T> FLEXAPOD_FLAT void finish(Wanted wanted, HalfBidiagonal<T>& half, SingularSquares<T>& found) {
  found = finished(wanted, half);
}

/// The second half of the work of `count` matrices, as many of them side by side as go into a wide pack.
template <class T>
FLEXAPOD_FLAT void finish_all(Wanted wanted, const HalfBidiagonal<T>* half, SingularSquares<T>* found, int count) {
  using Wide = typename T::Wide;
  constexpr int share = Wide::parts / T::parts;
  for (int i = 0; i < count; i += share) {
    HalfBidiagonal<Wide> wide;
    for (int s = 0; s < share; ++s)
      half[i + s < count ? i + s : i].for_each(wide, [&](const T& from, Wide& to) { to.set_share(s, from); });
    const SingularSquares<Wide> all = finished(wanted, wide);
    for (int s = 0; s < share && i + s < count; ++s) {
      found[i + s].sum = all.sum.template share<T>(s);
      for (int k = 0; k < 6; ++k) found[i + s].share[k] = all.share[k].template share<T>(s);
    }
  }
}

}  // namespace flexapod
