// Where the numbers of a structure are, said by the core itself: Python reads these tables and knows no offset.
#pragma once

#include <array>
#include <cstddef>

#include "numbers/packed.hpp"
#include "numbers/vec3.hpp"

namespace flexapod {

/// One value of each leg.
template <class T> using EachLeg = T[6];

enum class FieldShape {
  number,      // ()
  pair,        // (2,)
  vector,      // (3,)
  nodes,       // (24,)
  matrix,      // (3, 3) by rows
  symmetric,   // (3, 3) as xx yy zz xy xz yz
  symmetric6,  // (6, 6), the lower triangle by rows
};

/// One named value, or one of each leg, in a structure of doubles.
struct Field {
  const char* name;  // the dotted key of the design file, where it has one
  int offset;        // of its first number
  int stride;        // numbers from one leg's value to the next; 0: it is not given for each leg
  FieldShape shape;  // of the value, or of one leg's
  const char* unit;

  constexpr int rows() const {
    constexpr int of_shape[] = {1, 2, 3, table_capacity, 3, 3, 6};
    return of_shape[static_cast<int>(shape)];
  }
  constexpr int columns() const { return shape >= FieldShape::matrix ? rows() : 1; }
  constexpr bool is_symmetric() const { return shape >= FieldShape::symmetric; }
  /// Where the entry of a leg's value is; a symmetric matrix has each number beside the diagonal once.
  constexpr int at(int leg, int row, int column) const {
    constexpr int symmetric[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    const int first = offset + leg * stride;
    if (shape == FieldShape::symmetric6) return first + Sym6<double>::place(row, column);
    return first + (shape == FieldShape::symmetric ? symmetric[row][column] : row * columns() + column);
  }
};

template <class T> inline constexpr FieldShape field_shape = FieldShape::number;
template <> inline constexpr FieldShape field_shape<Pair<double>> = FieldShape::pair;
template <> inline constexpr FieldShape field_shape<Nodes<double>> = FieldShape::nodes;
template <> inline constexpr FieldShape field_shape<Sym6<double>> = FieldShape::symmetric6;
template <> inline constexpr FieldShape field_shape<Vec3<double>> = FieldShape::vector;
template <> inline constexpr FieldShape field_shape<Mat3<double>> = FieldShape::matrix;
template <> inline constexpr FieldShape field_shape<Sym3<double>> = FieldShape::symmetric;

/// The entry for a member of type T at an offset in bytes; one that is an array of six has a value for each leg.
template <class T> constexpr Field field(const char* name, std::size_t bytes, const char* unit, int stride = 0) {
  using Value = std::remove_extent_t<T>;
  const int size = static_cast<int>(sizeof(Value) / sizeof(double));
  const int offset = static_cast<int>(bytes / sizeof(double));
  return {name, offset, std::is_array_v<T> ? size : stride, field_shape<Value>, unit};
}

/// Whether the fields hold each of `size` numbers exactly once (a symmetric matrix names some of them twice).
template <int size, std::size_t n> constexpr bool cover(const std::array<Field, n>& fields) {
  int count[size] = {};
  for (const Field& f : fields)
    for (int leg = 0; leg < (f.stride > 0 ? 6 : 1); ++leg)
      for (int row = 0; row < f.rows(); ++row)
        for (int column = 0; column < f.columns(); ++column)
          if (!f.is_symmetric() || column >= row) ++count[f.at(leg, row, column)];
  for (const int c : count)
    if (c != 1) return false;
  return true;
}

}  // namespace flexapod
