// Many poses at once: a scalar made of lanes. `Pack<V, N>` is N hardware vectors V; more than one hides the latency of
// square roots and quotients. V is `double` itself where the compiler has no vector types, or FLEXAPOD_PLAIN is defined.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "numbers/scalar.hpp"

#if defined(__AVX512F__) || defined(__AVX2__) || defined(__SSE2__)
#include <immintrin.h>
#endif

namespace flexapod {

#if (defined(__GNUC__) || defined(__clang__)) && !defined(FLEXAPOD_PLAIN)
#if defined(__AVX512F__)
using Vector = double __attribute__((vector_size(64)));
#elif defined(__AVX2__)
using Vector = double __attribute__((vector_size(32)));
#else
using Vector = double __attribute__((vector_size(16)));
#endif
#else
using Vector = double;
#endif

/// Which lanes a condition holds in.
template <class V, int N> struct Mask {
  using Bits = decltype(V{} < V{});
  Bits m[N];

  friend FLEXAPOD_INLINE Mask operator&(Mask a, const Mask& b) {
    for (int i = 0; i < N; ++i) a.m[i] = a.m[i] & b.m[i];
    return a;
  }
  friend FLEXAPOD_INLINE Mask operator|(Mask a, const Mask& b) {
    for (int i = 0; i < N; ++i) a.m[i] = a.m[i] | b.m[i];
    return a;
  }
  friend FLEXAPOD_INLINE Mask operator!(Mask a) {
    for (int i = 0; i < N; ++i) a.m[i] = a.m[i] == Bits{};
    return a;
  }
};

template <class V, int N> FLEXAPOD_INLINE bool any(const Mask<V, N>& mask) {
  auto all = mask.m[0];
  for (int i = 1; i < N; ++i) all = all | mask.m[i];
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64) return _mm512_test_epi64_mask((__m512i)all, (__m512i)all) != 0;
#endif
#if defined(__AVX2__)
  if constexpr (sizeof(V) == 32) return _mm256_movemask_pd((__m256d)all) != 0;
#endif
#if defined(__SSE2__)
  if constexpr (sizeof(V) == 16) return _mm_movemask_pd((__m128d)all) != 0;
#endif
  std::int64_t bits[sizeof(all) > 8 ? sizeof(all) / 8 : 1] = {};
  std::memcpy(bits, &all, sizeof(all));
  std::int64_t found = 0;
  for (const std::int64_t b : bits) found |= b;
  return found != 0;
}

/// How quotients and square roots are found: rounded as IEEE 754 has it, or, where the processor has estimates of them,
/// from these by Newton's method, to two roundings and several times as fast. What is divided by zero, or by less than
/// 1e-308, is NaN then.
enum class Division { exact, quick };

namespace detail {
template <class V> FLEXAPOD_INLINE V rounded_sqrt(V a) {
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64) return (V)_mm512_maskz_sqrt_pd(0xff, (__m512d)a);
#endif
#if defined(__AVX2__)
  if constexpr (sizeof(V) == 32) return (V)_mm256_sqrt_pd((__m256d)a);
#endif
#if defined(__SSE2__)
  if constexpr (sizeof(V) == 16) return (V)_mm_sqrt_pd((__m128d)a);
#endif
  double x[sizeof(V) / sizeof(double)];
  std::memcpy(x, &a, sizeof(V));
  for (double& number : x) number = std::sqrt(number);
  std::memcpy(&a, x, sizeof(V));
  return a;
}

#if defined(__AVX512F__)
template <class V, Division how> inline constexpr bool estimated = how == Division::quick && sizeof(V) == 64;

/// 1/sqrt(a) to 41 bits.
template <class V> FLEXAPOD_INLINE V nearly_rsqrt(V a) {
  const V y = (V)_mm512_maskz_rsqrt14_pd(0xff, (__m512d)a);
  const V e = 1.0 - (a * y) * y;
  return y + (y * e) * (0.5 + 0.375 * e);
}
#else
template <class V, Division how> inline constexpr bool estimated = false;
#endif

template <Division how, class V> FLEXAPOD_INLINE V quotient(V a, V b) {
#if defined(__AVX512F__)
  if constexpr (estimated<V, how>) {
    const V estimate = (V)_mm512_maskz_rcp14_pd(0xff, (__m512d)b);
    const V e = 1.0 - b * estimate;
    const V inverse = estimate + estimate * (e + e * e);  // to 42 bits
    const V q = a * inverse;
    return q + (a - b * q) * inverse;
  }
#endif
  return a / b;
}
template <Division how, class V> FLEXAPOD_INLINE V root(V a) {
#if defined(__AVX512F__)
  if constexpr (estimated<V, how>) {
    const V y = nearly_rsqrt(a), root = a * y;
    return a == 0.0 ? a : root + (a - root * root) * (0.5 * y);
  }
#endif
  return rounded_sqrt(a);
}
template <Division how, class V> FLEXAPOD_INLINE V inverse_root(V a) {
#if defined(__AVX512F__)
  if constexpr (estimated<V, how>) {
    const V y = nearly_rsqrt(a);
    return y + (0.5 * y) * (1.0 - (a * y) * y);
  }
#endif
  return 1.0 / rounded_sqrt(a);
}
}  // namespace detail

template <class V, int N, Division how = Division::exact> struct Pack {
  static constexpr int lanes = N * static_cast<int>(sizeof(V) / sizeof(double));
  V v[N];

  Pack() = default;
  FLEXAPOD_INLINE Pack(double x) {  // NOLINT: a number is a pack of equal lanes
    for (int i = 0; i < N; ++i) v[i] = x - V{};
  }
  static FLEXAPOD_INLINE Pack load(const double* p) {
    Pack r;
    std::memcpy(r.v, p, sizeof(r.v));
    return r;
  }
  /// Numbers that lie `step` apart.
  static FLEXAPOD_INLINE Pack gather(const double* p, std::size_t step) {
    Pack r;
    for (int i = 0; i < N; ++i) {
      if constexpr (sizeof(V) == sizeof(double)) {
        r.v[i] = p[i * step];
      } else {
        V all;
        FLEXAPOD_UNROLL
        for (int l = 0; l < lanes / N; ++l) all[l] = p[(i * (lanes / N) + l) * step];
        r.v[i] = all;
      }
    }
    return r;
  }
  using Part = Pack<V, 1, how>;      // one of its vectors
  using Wide = Pack<V, 2 * N, how>;  // two packs side by side
  static constexpr int parts = N;
  FLEXAPOD_INLINE void set_part(int i, const Part& part) { v[i] = part.v[0]; }
  /// The i-th of the packs that are side by side in this one.
  template <class P> FLEXAPOD_INLINE void set_share(int i, const P& share) {
    for (int j = 0; j < P::parts; ++j) v[i * P::parts + j] = share.v[j];
  }
  template <class P> FLEXAPOD_INLINE P share(int i) const {
    P share;
    for (int j = 0; j < P::parts; ++j) share.v[j] = v[i * P::parts + j];
    return share;
  }
  FLEXAPOD_INLINE void store(double* p) const { std::memcpy(p, v, sizeof(v)); }

  FLEXAPOD_INLINE Pack& operator+=(const Pack& b) { return *this = *this + b; }
  FLEXAPOD_INLINE Pack& operator-=(const Pack& b) { return *this = *this - b; }
  FLEXAPOD_INLINE Pack& operator*=(const Pack& b) { return *this = *this * b; }

#define FLEXAPOD_OPERATOR(op)                                             \
  friend FLEXAPOD_INLINE Pack operator op(const Pack& a, const Pack& b) { \
    Pack r;                                                               \
    for (int i = 0; i < N; ++i) r.v[i] = a.v[i] op b.v[i];                \
    return r;                                                             \
  }
  FLEXAPOD_OPERATOR(+)
  FLEXAPOD_OPERATOR(-)
  FLEXAPOD_OPERATOR(*)
#undef FLEXAPOD_OPERATOR
#define FLEXAPOD_COMPARISON(op)                                                 \
  friend FLEXAPOD_INLINE Mask<V, N> operator op(const Pack& a, const Pack& b) { \
    Mask<V, N> r;                                                               \
    for (int i = 0; i < N; ++i) r.m[i] = a.v[i] op b.v[i];                      \
    return r;                                                                   \
  }
  FLEXAPOD_COMPARISON(<)
  FLEXAPOD_COMPARISON(>)
  FLEXAPOD_COMPARISON(<=)
  FLEXAPOD_COMPARISON(>=)
#undef FLEXAPOD_COMPARISON
  friend FLEXAPOD_INLINE Pack operator/(const Pack& a, const Pack& b) {
    Pack r;
    for (int i = 0; i < N; ++i) r.v[i] = detail::quotient<how>(a.v[i], b.v[i]);
    return r;
  }
  friend FLEXAPOD_INLINE Pack operator-(const Pack& a) {
    Pack r;
    for (int i = 0; i < N; ++i) r.v[i] = -a.v[i];
    return r;
  }
};

template <class V, int N, Division how> struct is_scalar<Pack<V, N, how>> : std::true_type {};

template <class V, int N, Division how>
FLEXAPOD_INLINE Pack<V, N, how> select(const Mask<V, N>& take_a, const Pack<V, N, how>& a, const Pack<V, N, how>& b) {
  Pack<V, N, how> r;
  for (int i = 0; i < N; ++i) r.v[i] = take_a.m[i] ? a.v[i] : b.v[i];
  return r;
}

template <class V, int N, Division how> FLEXAPOD_INLINE Pack<V, N, how> abs(const Pack<V, N, how>& a) {
  return select(a < 0.0, -a, a);
}

/// The sum of all lanes.
template <class V, Division how> FLEXAPOD_INLINE double sum(const Pack<V, 1, how>& a) {
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64) {
    const __m512d all = (__m512d)a.v[0];
    const __m256d four = _mm256_add_pd(_mm512_castpd512_pd256(all), _mm512_maskz_extractf64x4_pd(0xff, all, 1));
    const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
    return _mm_cvtsd_f64(two) + _mm_cvtsd_f64(_mm_unpackhi_pd(two, two));
  }
#endif
#if defined(__AVX2__)
  if constexpr (sizeof(V) == 32) {
    const __m256d four = (__m256d)a.v[0];
    const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd(four, 1));
    return _mm_cvtsd_f64(two) + _mm_cvtsd_f64(_mm_unpackhi_pd(two, two));
  }
#endif
  double lane[Pack<V, 1, how>::lanes], total = 0;
  a.store(lane);
  for (const double value : lane) total += value;
  return total;
}

template <class V, int N, Division how> FLEXAPOD_INLINE Pack<V, N, how> sqrt(const Pack<V, N, how>& a) {
  Pack<V, N, how> r;
  for (int i = 0; i < N; ++i) r.v[i] = detail::root<how>(a.v[i]);
  return r;
}
template <class V, int N, Division how> FLEXAPOD_INLINE Pack<V, N, how> rsqrt(const Pack<V, N, how>& a) {
  Pack<V, N, how> r;
  for (int i = 0; i < N; ++i) r.v[i] = detail::inverse_root<how>(a.v[i]);
  return r;
}

}  // namespace flexapod
