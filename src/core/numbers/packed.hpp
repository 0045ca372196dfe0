// Small values of a design besides numbers, vectors and 3x3 matrices: scalars of one type and nothing else.
#pragma once

namespace flexapod {

template <class T> struct Pair {
  T a[2]{};

  const T& operator[](int i) const { return a[i]; }
};

/// A symmetric 6x6 matrix: its lower triangle by rows.
template <class T> struct Sym6 {
  T a[21]{};

  static constexpr int place(int row, int column) {
    return row >= column ? row * (row + 1) / 2 + column : column * (column + 1) / 2 + row;
  }
  const T& at(int row, int column) const { return a[place(row, column)]; }
};

/// A column of a table: so many numbers at most.
inline constexpr int table_capacity = 24;
template <class T> struct Nodes {
  T a[table_capacity]{};

  const T& operator[](int i) const { return a[i]; }
};

}  // namespace flexapod
