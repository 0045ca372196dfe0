// Many poses at once: a scalar made of lanes. `Pack<V, N>` is N hardware vectors V; more than one hides the latency of
// square roots and quotients. V is `double` itself where the compiler has no vector types, or FLEXAPOD_PLAIN is defined.
#pragma once

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

template <class V, int N> struct Pack {
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
  using Part = Pack<V, 1>;  // one of its vectors
  static constexpr int parts = N;
  FLEXAPOD_INLINE void set_part(int i, const Part& part) { v[i] = part.v[0]; }
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
  FLEXAPOD_OPERATOR(/)
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
  friend FLEXAPOD_INLINE Pack operator-(const Pack& a) {
    Pack r;
    for (int i = 0; i < N; ++i) r.v[i] = -a.v[i];
    return r;
  }
};

template <class V, int N> struct is_scalar<Pack<V, N>> : std::true_type {};

template <class V, int N>
FLEXAPOD_INLINE Pack<V, N> select(const Mask<V, N>& take_a, const Pack<V, N>& a, const Pack<V, N>& b) {
  Pack<V, N> r;
  for (int i = 0; i < N; ++i) r.v[i] = take_a.m[i] ? a.v[i] : b.v[i];
  return r;
}

template <class V, int N> FLEXAPOD_INLINE Pack<V, N> abs(const Pack<V, N>& a) { return select(a < 0.0, -a, a); }

namespace detail {
template <class V> FLEXAPOD_INLINE V sqrt_vector(V a) {
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
}  // namespace detail

/// The sum of all lanes.
template <class V> FLEXAPOD_INLINE double sum(const Pack<V, 1>& a) {
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
  double lane[Pack<V, 1>::lanes], total = 0;
  a.store(lane);
  for (const double value : lane) total += value;
  return total;
}

template <class V, int N> FLEXAPOD_INLINE Pack<V, N> sqrt(const Pack<V, N>& a) {
  Pack<V, N> r;
  for (int i = 0; i < N; ++i) r.v[i] = detail::sqrt_vector(a.v[i]);
  return r;
}
template <class V, int N> FLEXAPOD_INLINE Pack<V, N> rsqrt(const Pack<V, N>& a) {
  Pack<V, N> r;
  for (int i = 0; i < N; ++i) r.v[i] = 1.0 / detail::sqrt_vector(a.v[i]);
  return r;
}

}  // namespace flexapod
