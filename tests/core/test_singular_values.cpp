// Singular values of 6 x m matrices against rotations in long double, whose errors are 2000 times smaller.
#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "decomposition/singular_lanes.hpp"
#include "example.hpp"

namespace flexapod {
namespace {

using Lanes = Pack<Vector, 2>;
using Wide = long double;

/// One-sided Jacobi rotations, independent of the core's.
template <int m> std::array<Wide, 6> reference(const Mat6<double, m>& B) {
  Wide row[6][m];
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < m; ++k) row[i][k] = B[i][k];
  for (int sweep = 0; sweep < 60; ++sweep)
    for (int p = 0; p < 5; ++p)
      for (int q = p + 1; q < 6; ++q) {
        Wide pp = 0, qq = 0, pq = 0;
        for (int k = 0; k < m; ++k)
          pp += row[p][k] * row[p][k], qq += row[q][k] * row[q][k], pq += row[p][k] * row[q][k];
        if (pq == 0) continue;
        const Wide angle = std::atan2(2 * pq, qq - pp) / 2, c = std::cos(angle), s = std::sin(angle);
        for (int k = 0; k < m; ++k) {
          const Wide x = row[p][k], y = row[q][k];
          row[p][k] = c * x - s * y, row[q][k] = s * x + c * y;
        }
      }
  std::array<Wide, 6> sigma{};
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < m; ++k) sigma[i] += row[i][k] * row[i][k];
    sigma[i] = std::sqrt(sigma[i]);
  }
  std::sort(sigma.begin(), sigma.end());
  return sigma;
}

/// Random numbers, then rows and columns mixed after row i was scaled by ratio^(i/5).
template <int m> Mat6<double, m> graded(example::Draw& draw, double ratio) {
  Mat6<double, m> B;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < m; ++j) B[i][j] = std::pow(ratio, i / 5.0) * draw(-1.0, 1.0);
  for (int p = 0; p < 5; ++p)
    for (int q = p + 1; q < 6; ++q) {
      const double angle = draw(-3.0, 3.0);
      turn(B.a[p], B.a[q], std::cos(angle), std::sin(angle));
    }
  return B;
}

template <int m> struct Many {
  Mat6<double, m> lane[Lanes::lanes];
  Mat6<Lanes, m> packed;

  Many(example::Draw& draw, double ratio) {
    for (auto& B : lane) B = graded<m>(draw, ratio);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < m; ++j) {
        double x[Lanes::lanes];
        for (int l = 0; l < Lanes::lanes; ++l) x[l] = lane[l][i][j];
        packed[i][j] = Lanes::load(x);
      }
  }
};

std::array<std::array<double, Lanes::lanes>, 6> sigma(const SingularSquares<Lanes>& found,
                                                      std::initializer_list<int> wanted) {
  std::array<std::array<double, Lanes::lanes>, 6> all{};
  for (const int i : wanted) sqrt(found.share[i] * found.sum).store(all[i].data());
  return all;
}

/// Largest error of the lanes' singular values in units of eps times the largest one.
template <int m> double worst_error(double ratio) {
  example::Draw draw(17 + m);
  double worst = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Many<m> many(draw, ratio);
    const auto matrix = [&] { return many.packed; };
    const auto all = sigma(singular_squares<Wanted::all, Lanes>(matrix), {0, 1, 2, 3, 4, 5});
    const auto low = sigma(singular_squares<Wanted::lowest, Lanes>(matrix), {0});
    const auto ends = sigma(singular_squares<Wanted::extremes, Lanes>(matrix), {0, 5});
    for (int l = 0; l < Lanes::lanes; ++l) {
      const auto exact = reference(many.lane[l]);
      const SingularValues one(many.lane[l]);
      const auto note = [&](double found, int i) {
        worst = std::max(worst, std::abs(static_cast<double>((found - exact[i]) / exact[5])) / 2.2e-16);
      };
      for (int i = 0; i < 6; ++i) note(all[i][l], i), note(one.sigma[i], i);
      note(low[0][l], 0), note(ends[0][l], 0), note(ends[5][l], 5);
    }
  }
  return worst;
}

// An error of 100 eps of the largest is one of 100 eps cond(B) of the least, which a product B B^T would exceed.
TEST_CASE_TEMPLATE("singular values of 6 x m matrices are right to 100 eps of the largest", Columns,
                   std::integral_constant<int, 6>, std::integral_constant<int, 8>, std::integral_constant<int, 12>) {
  for (const double ratio : {1.0, 1e3, 1e6, 1e9, 1e12}) {
    CAPTURE(ratio);
    CHECK(worst_error<Columns::value>(ratio) < 100.0);  // 4 to 20 on a common machine
  }
}

TEST_CASE("repeated singular values, where the bidiagonal form gives up") {
  Mat6<Lanes, 8> B;
  for (int i = 0; i < 6; ++i) B[i][i] = Lanes(i < 3 ? 2.0 : 5.0);
  const auto all = sigma(singular_squares<Wanted::all, Lanes>([&] { return B; }), {0, 1, 2, 3, 4, 5});
  for (int i = 0; i < 6; ++i)
    for (const double x : all[i]) CHECK(x == doctest::Approx(i < 3 ? 2.0 : 5.0).epsilon(1e-14));
}

TEST_CASE("matrices side by side have the singular values of each by itself") {
  constexpr int packs = 5;  // an odd number: the last goes alone
  example::Draw draw(23);
  HalfBidiagonal<Lanes> half[packs];
  SingularSquares<Lanes> found[packs];
  std::vector<Many<6>> many;
  for (int i = 0; i < packs; ++i) {
    many.emplace_back(draw, 1e4);
    Mat6<Lanes> matrix = many[i].packed;
    begin(matrix, half[i]);
  }
  finish_all(Wanted::extremes, half, found, packs);
  for (int i = 0; i < packs; ++i) {
    const auto both = sigma(found[i], {0, 5});
    for (int l = 0; l < Lanes::lanes; ++l) {
      const auto exact = reference(many[i].lane[l]);
      for (const int k : {0, 5})
        CHECK(std::abs(static_cast<double>((both[k][l] - exact[k]) / exact[5])) < 100 * 2.2e-16);
    }
  }
}

TEST_CASE("left singular vectors turn B into orthogonal rows") {
  example::Draw draw(3);
  const Mat6<double, 12> B = graded<12>(draw, 100.0);
  const SingularValues values(B);
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b < 6; ++b) {
      double product = 0;
      for (int k = 0; k < 12; ++k) {
        double first = 0, second = 0;
        for (int i = 0; i < 6; ++i) first += values.u[i][a] * B[i][k], second += values.u[i][b] * B[i][k];
        product += first * second;
      }
      const double expected = a == b ? values.sigma[a] * values.sigma[a] : 0.0;
      CHECK(std::abs(product - expected) < 1e-14 * values.sigma[5] * values.sigma[5]);
    }
}

}  // namespace
}  // namespace flexapod
