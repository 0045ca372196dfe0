// Every pose at which the legs have given lengths, by homotopy continuation over the complex numbers.
//
// A machine whose joints and lengths are general complex numbers has 40 solutions. Carried along while the numbers change
// into those of a machine at hand, they end at all its isolated solutions: see docs/theory/kinematics.md.
#pragma once

#include <cstdint>
#include <vector>

#include "model/homotopy.hpp"
#include "model/kinematics.hpp"

namespace flexapod::assemblies {

using namespace homotopy;

inline constexpr int most = 40;  // solutions of a general machine

/// Numbers without a relation to anything: evenly in a square about zero, the same on every computer.
class General {
 public:
  explicit General(std::uint64_t seed) : state_(seed) {}
  Complex number() {
    const double re = real(), im = real();
    return {re, im};
  }

 private:
  std::uint64_t state_;
  double real() {  // SplitMix64
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return double((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  }
};

/// Distance of two points of projective space, both of size 1: the sine of the angle between them.
inline double apart(const Study& x, const Study& y) {
  Complex along = 0;
  for (int i = 0; i < 8; ++i) along += std::conj(x[i]) * y[i];
  return std::sqrt(size2(sum(y, -along, x)));
}
inline bool holds(const std::vector<Study>& points, const Study& x, double tolerance = 1e-6) {
  return std::any_of(points.begin(), points.end(), [&](const Study& y) { return apart(x, y) < tolerance; });
}

/// The numbers of the same joints with lengths that have no relation to anything; so far off that their paths go round
/// what lies between.
inline Numbers with_general_lengths(Numbers n, General& random) {
  for (Complex& c : n.c) c = 30.0 * random.number();
  return n;
}
inline Numbers general_numbers(General& random) {
  Numbers n;
  for (auto* joints : {n.b, n.p})
    for (int i = 0; i < 6; ++i) {
      const Complex x = random.number(), y = random.number();
      joints[i] = {x, y, random.number()};
    }
  return with_general_lengths(n, random);
}

/// Numbers and all their solutions.
struct Solved {
  Numbers numbers;
  std::vector<Study> points;
  bool complete = true;
};

/// A general machine with its 40 solutions, made once: one solution is chosen and the lengths follow; the others are
/// where it goes while the lengths run round closed loops (monodromy).
inline const Solved& general() {
  static const Solved solved = [] {
    General random(20071998);
    Solved s{general_numbers(random), {}, false};
    Study x;
    for (Complex& z : x.a) z = random.number();
    x[4] = -(x[1] * x[5] + x[2] * x[6] + x[3] * x[7]) / x[0];
    for (int i = 0; i < 6; ++i)  // the equation is linear in c, with the factor e.e
      s.numbers.c[i] -= half_product(gradient(s.numbers, i, x), x) / quaternion2(x);
    s.points = {normalised(x)};
    for (int loop = 0; loop < 200 && s.points.size() < most; ++loop) {
      const Numbers stations[3] = {s.numbers, with_general_lengths(s.numbers, random),
                                   with_general_lengths(s.numbers, random)};
      const std::size_t known = s.points.size();
      for (std::size_t start = 0; start < known; ++start) {
        Endpoint at{s.points[start], End::regular};
        for (int k = 0; k < 3 && at.end == End::regular; ++k)
          at = Path(stations[k], stations[(k + 1) % 3], {}).follow(at.x);
        if (at.end == End::regular && !holds(s.points, at.x)) s.points.push_back(at.x);
      }
    }
    s.complete = s.points.size() == most;
    return s;
  }();
  return solved;
}

/// Where the paths from all solutions of some numbers to others end. Incomplete, where a path was lost or left for
/// another: then two of them end at one regular point.
struct Ends {
  std::vector<Study> regular, singular;
  bool complete;

  Ends(const Solved& from, const Numbers& to, const Care& care) : complete(from.complete) {
    const Path path(from.numbers, to, care);
    for (const Study& start : from.points) {
      const Endpoint found = path.follow(start);
      if (found.end == End::lost || (found.end == End::regular && holds(regular, found.x, 1e-9))) complete = false;
      if (found.end == End::regular) regular.push_back(found.x);
      if (found.end == End::singular) singular.push_back(found.x);
    }
  }
};

inline constexpr Care cares[] = {{0.1, 1e-4}, {0.05, 1e-5}, {0.03, 1e-6}};  // one after the other, until complete

/// The design, and how its numbers come of it: about the centres of its joints, in a unit of its size.
struct Scaled {
  Design<double> design;
  Vec3<double> base_centre, platform_centre;
  double unit = 0;

  explicit Scaled(const Design<double>& d) : design(d) {
    for (int i = 0; i < 6; ++i) base_centre += (1.0 / 6) * d.b[i], platform_centre += (1.0 / 6) * d.p[i];
    for (int i = 0; i < 6; ++i) unit = std::max({unit, norm(d.b[i] - base_centre), norm(d.p[i] - platform_centre)});
  }
  Numbers numbers(const double (&length)[6]) const {
    Numbers n;
    for (int i = 0; i < 6; ++i) {
      const Vec3<double> b = (1 / unit) * (design.b[i] - base_centre), p = (1 / unit) * (design.p[i] - platform_centre);
      n.b[i] = b, n.p[i] = p, n.c[i] = dot(b, b) + dot(p, p) - length[i] * length[i] / (unit * unit);
    }
    return n;
  }
  /// The real pose of a point, which has been made as real as it can be.
  Pose<double> pose(const Study& x) const {
    const Vec3<double> e{x[1].real(), x[2].real(), x[3].real()}, g{x[5].real(), x[6].real(), x[7].real()};
    const double e0 = x[0].real(), g0 = x[4].real(), e2 = e0 * e0 + dot(e, e);
    const auto turned = [&](const Vec3<double>& v) {
      return (1 / e2) * ((e0 * e0 - dot(e, e)) * v + 2.0 * dot(e, v) * e + 2.0 * e0 * cross(e, v));
    };
    const Mat3<double> columns{{turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})}};
    const Vec3<double> t = (2 * unit / e2) * (e0 * g - g0 * e + cross(e, g));
    return {t + base_centre - turned(platform_centre), transpose(columns)};
  }
};

/// All solutions of a design with general lengths, which are regular. Their paths end at all isolated solutions for any
/// lengths. A second attempt goes by way of another general machine, as one path may pass too close to infinity.
inline Solved with_general_lengths(const Scaled& scaled, int attempt) {
  General random(1 + attempt);
  const Numbers wanted = with_general_lengths(scaled.numbers({0, 0, 0, 0, 0, 0}), random);
  const auto reached = [&](const Solved& from, const Numbers& to) {
    Ends ends(from, to, cares[attempt]);
    return Solved{to, std::move(ends.regular), ends.complete && ends.singular.empty()};
  };
  return attempt == 0 ? reached(general(), wanted) : reached(reached(general(), general_numbers(random)), wanted);
}

struct Found {
  std::vector<FoundPose> poses;
  bool complete = false;
};

/// A point times the factor that makes its largest e real; how far it then is from real, of that e.
inline double made_real(Study& x) {
  int largest = 0;
  for (int i = 1; i < 4; ++i)
    if (std::norm(x[i]) > std::norm(x[largest])) largest = i;
  if (!(std::norm(x[largest]) > 1e-10 * size2(x))) return INFINITY;  // at infinity
  x = scaled(x, 1.0 / x[largest]);
  double imaginary = 0;
  for (const Complex& z : x.a) imaginary = std::max(imaginary, std::abs(z.imag()));
  return imaginary;
}

/// Whether with every solution its conjugate is there: it is, where the numbers are real and no path was left.
inline bool in_pairs(const std::vector<Study>& points) {
  return std::all_of(points.begin(), points.end(), [&](Study x) {
    for (Complex& z : x.a) z = std::conj(z);
    return holds(points, x, 1e-6);
  });
}

/// All assemblies of a design, for one set of lengths after the other.
class Search {
 public:
  explicit Search(const Design<double>& d) : scaled_(d) {
    for (int attempt = 0; attempt < attempts && !start_.complete; ++attempt)
      start_ = with_general_lengths(scaled_, attempt);
  }

  /// Assemblies for general lengths, complex ones too; -1 where they were not all found.
  int paths() const { return start_.complete ? int(start_.points.size()) : -1; }

  Found assemblies(const double (&length)[6]) const {
    const Numbers wanted = scaled_.numbers(length);
    Found found;
    for (int attempt = 0; attempt < attempts && !found.complete; ++attempt) {
      const Ends ends(attempt == 0 ? start_ : with_general_lengths(scaled_, attempt), wanted, cares[attempt]);
      for (const Study& x : ends.regular) add(found, x, length, 1e-3, 1e-8);
      for (const Study& x : ends.singular) add(found, x, length, 0.1, 1e-5);
      found.complete = ends.complete && in_pairs(ends.regular);
    }
    return found;
  }

 private:
  static constexpr int attempts = std::size(cares);
  Scaled scaled_;
  Solved start_{{}, {}, false};

  /// Adds a point that is real, to rounding after Newton's method, and not there yet.
  void add(Found& found, Study x, const double (&length)[6], double nearly_real, double same) const {
    if (!(made_real(x) < nearly_real)) return;
    const FoundPose polished = forward_kinematics(scaled_.design, length, scaled_.pose(x));
    if (!(polished.error <= 1e-11 * *std::max_element(length, length + 6))) return;
    const auto near = [&](const FoundPose& other) {
      double off = norm(polished.pose.t - other.pose.t) / scaled_.unit;
      for (int i = 0; i < 3; ++i) off = std::max(off, norm(polished.pose.R.row[i] - other.pose.R.row[i]));
      return off < same;
    };
    if (std::none_of(found.poses.begin(), found.poses.end(), near)) found.poses.push_back(polished);
  }
};

}  // namespace flexapod::assemblies
