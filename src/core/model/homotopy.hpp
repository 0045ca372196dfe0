// Leg lengths as polynomial equations over the complex numbers, and their solutions followed while the machine changes.
//
// In Study's coordinates, x = (e, g) with R from the quaternion e and t = 2 g e* / (e.e), each leg's length is one
// quadratic equation in x, and e.g = 0 is the seventh.
#pragma once

#include <complex>

#include "numbers/vec3.hpp"

namespace flexapod {
template <> struct is_scalar<std::complex<double>> : std::true_type {};
}  // namespace flexapod

namespace flexapod::homotopy {

using Complex = std::complex<double>;
using Vec3c = Vec3<Complex>;

/// A point of projective space: the quaternion e, then g.
struct Study {
  Complex a[8];
  Complex& operator[](int i) { return a[i]; }
  const Complex& operator[](int i) const { return a[i]; }
};

inline double size2(const Study& x) {
  double sum = 0;
  for (const Complex& z : x.a) sum += std::norm(z);
  return sum;
}
FLEXAPOD_APART inline Study scaled(const Study& x, Complex factor) {
  Study y;
  for (int i = 0; i < 8; ++i) y[i] = factor * x[i];
  return y;
}
FLEXAPOD_APART inline Study sum(const Study& x, Complex factor, const Study& y) {
  Study z;
  for (int i = 0; i < 8; ++i) z[i] = x[i] + factor * y[i];
  return z;
}
inline Study normalised(const Study& x) { return scaled(x, 1.0 / std::sqrt(size2(x))); }
inline Complex quaternion2(const Study& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]; }

/// Joints in a unit of the machine's size, and c = p.p + b.b - L^2: what the equations are made of.
struct Numbers {
  Vec3c b[6], p[6];
  Complex c[6];
};

/// Numbers on the way from one machine to another.
FLEXAPOD_APART inline Numbers between(const Numbers& from, const Numbers& to, double t) {
  Numbers n;
  const double u = 1.0 - t, v = t;
  for (int i = 0; i < 6; ++i) {
    n.b[i] = u * from.b[i] + v * to.b[i];
    n.p[i] = u * from.p[i] + v * to.p[i];
    n.c[i] = u * from.c[i] + v * to.c[i];
  }
  return n;
}

/// Gradient of leg i's equation, |t + R p - b|^2 = L^2 times e.e; the equation is half of x times it.
FLEXAPOD_APART inline Study gradient(const Numbers& n, int i, const Study& x) {
  const Vec3c &b = n.b[i], &p = n.p[i], m = p - b, s = p + b, e{x[1], x[2], x[3]}, g{x[5], x[6], x[7]}, w = cross(p, b);
  const Complex e0 = x[0], g0 = x[4], c = n.c[i], bp = dot(b, p), pe = dot(p, e), be = dot(b, e);
  const Vec3c by_e = 2.0 * (c + 2.0 * bp) * e - 4.0 * (pe * b + be * p + e0 * w + g0 * m + cross(g, s));
  const Vec3c by_g = 8.0 * g + 4.0 * (e0 * m - cross(s, e));
  return {{2.0 * e0 * (c - 2.0 * bp) - 4.0 * dot(e, w) + 4.0 * dot(m, g), by_e.x, by_e.y, by_e.z,
           8.0 * g0 - 4.0 * dot(m, e), by_g.x, by_g.y, by_g.z}};
}

FLEXAPOD_APART inline Complex half_product(const Study& x, const Study& y) {
  Complex total = 0;
  for (int i = 0; i < 8; ++i) total += x[i] * y[i];
  return 0.5 * total;
}

/// Six lengths, e.g = 0, and that steps are across x: the linear system of predictor and corrector.
struct System {
  Complex matrix[8][8], right[8];

  System(const Numbers& n, const Study& x) {
    for (int i = 0; i < 6; ++i) set(i, gradient(n, i, x), x);
    set(6, {{x[4], x[5], x[6], x[7], x[0], x[1], x[2], x[3]}}, x);
    for (int j = 0; j < 8; ++j) matrix[7][j] = std::conj(x[j]);
    right[7] = 0;
  }
  /// Solves by elimination with row pivoting; false where a pivot vanishes.
  FLEXAPOD_APART bool solve(Study& step) {
    for (int k = 0; k < 8; ++k) {
      int pivot = k;
      for (int i = k + 1; i < 8; ++i)
        if (std::norm(matrix[i][k]) > std::norm(matrix[pivot][k])) pivot = i;
      if (!(std::norm(matrix[pivot][k]) > 1e-300)) return false;
      std::swap(matrix[k], matrix[pivot]);
      std::swap(right[k], right[pivot]);
      const Complex reciprocal = 1.0 / matrix[k][k];
      for (int i = k + 1; i < 8; ++i) {
        const Complex factor = matrix[i][k] * reciprocal;
        for (int j = k + 1; j < 8; ++j) matrix[i][j] -= factor * matrix[k][j];
        right[i] -= factor * right[k];
      }
    }
    for (int i = 7; i >= 0; --i) {
      Complex value = right[i];
      for (int j = i + 1; j < 8; ++j) value -= matrix[i][j] * step[j];
      step[i] = value / matrix[i][i];
    }
    return true;
  }

 private:
  void set(int row, const Study& slope, const Study& x) {
    for (int j = 0; j < 8; ++j) matrix[row][j] = slope[j];
    right[row] = -half_product(slope, x);
  }
};

/// How carefully a path is followed.
struct Care {
  double longest = 0.1;      // step in t
  double prediction = 1e-4;  // what a predicted point may be off, of |x| = 1
};

/// At a regular point, at a singular one, at infinity (where e.e = 0), or nowhere.
enum class End { regular, singular, infinite, lost };
struct Endpoint {
  Study x;
  End end;
};

/// One path x(t) of the solutions of numbers that change with t from 0 to 1.
class Path {
 public:
  Path(const Numbers& from, const Numbers& to, const Care& care) : from_(from), to_(to), care_(care) {}

  FLEXAPOD_APART Endpoint follow(Study x) const {
    double t = 0, h = care_.longest;
    for (int step = 0; step < 20000; ++step) {
      const bool last = h >= 1.0 - t;
      const double next = last ? 1.0 : t + h;
      Study y = x;
      double off = 0;
      if (predict(y, t, next - t) && correct(y, next, off)) {
        x = normalised(y), t = next;
        if (last) return {x, End::regular};
        if (off < 0.03 * care_.prediction) h = std::min(2.0 * h, care_.longest);
      } else {
        h = 0.5 * (next - t);
        if (1.0 - t < 1e-9 || h < 1e-13) return {x, end(x, t)};
      }
    }
    return {x, End::lost};
  }

 private:
  const Numbers &from_, &to_;
  Care care_;

  static End end(const Study& x, double t) {
    if (1.0 - t > 1e-2) return End::lost;
    return std::abs(quaternion2(x)) < 1e-7 ? End::infinite : End::singular;
  }
  bool slope(const Study& x, double t, Study& rate) const {
    System system(between(from_, to_, t), x);
    const Numbers ahead = between(from_, to_, t + 0.5), behind = between(from_, to_, t - 0.5);
    for (int i = 0; i < 6; ++i)  // the equations are quadratic in t: their central difference is exact
      system.right[i] = half_product(gradient(behind, i, x), x) - half_product(gradient(ahead, i, x), x);
    system.right[6] = 0;
    return system.solve(rate);
  }
  bool predict(Study& x, double t, double h) const {  // Runge and Kutta's method of fourth order
    Study k1, k2, k3, k4;
    if (!slope(x, t, k1) || !slope(sum(x, 0.5 * h, k1), t + 0.5 * h, k2) ||
        !slope(sum(x, 0.5 * h, k2), t + 0.5 * h, k3) || !slope(sum(x, h, k3), t + h, k4))
      return false;
    for (int i = 0; i < 8; ++i) x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    return true;
  }
  /// Newton's method; off is the first correction.
  bool correct(Study& x, double t, double& off) const {
    const Numbers now = between(from_, to_, t);
    for (int k = 0; k < 4; ++k) {
      Study step;
      x = normalised(x);
      if (!System(now, x).solve(step)) return false;
      const double length = std::sqrt(size2(step));
      if (k == 0) off = length;
      if (!(length < care_.prediction)) return false;
      x = sum(x, 1.0, step);
      if (length < 1e-9) return true;  // what is left is its square
    }
    return false;
  }
};

}  // namespace flexapod::homotopy
