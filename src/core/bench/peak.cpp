// What the processor can do at most, for one instruction set: compiled as the kernels are.
#include <cstring>

#include "simd/pack.hpp"

namespace flexapod {
namespace {

/// Twelve chains of multiply and add that do not depend on one another: enough for any processor's latency.
double peak(size_t rounds) {
  constexpr int chains = 12;
  Vector x[chains];
  const Vector a = 0.999999 - Vector{}, b = 1e-6 - Vector{};
  for (int i = 0; i < chains; ++i) x[i] = i + Vector{};
  for (size_t r = 0; r < rounds; ++r) {
    FLEXAPOD_UNROLL
    for (int i = 0; i < chains; ++i) x[i] = x[i] * a + b;
  }
  Vector sum = x[0];
  for (int i = 1; i < chains; ++i) sum += x[i];
  double lane[sizeof(Vector) / sizeof(double)];
  std::memcpy(lane, &sum, sizeof(sum));
  [[maybe_unused]] volatile double needed;  // or a compiler would leave all of it out
  for (const double number : lane) needed = number;
  return 2.0 * chains * static_cast<double>(rounds) * (sizeof(Vector) / sizeof(double));
}

}  // namespace

extern double (*const peak_flops)(size_t rounds);
double (*const peak_flops)(size_t rounds) = &peak;

}  // namespace flexapod
