// What a number is to the rest of the core. The physics is written once over a scalar T: double (one pose),
// Dual (exact derivatives) or a pack of lanes (many poses at once). Each of them answers the calls below.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

#if defined(FLEXAPOD_SANITIZE)  // calls stay calls: the checks of all that is inlined would take minutes to compile
#define FLEXAPOD_INLINE inline
#define FLEXAPOD_FLAT
#define FLEXAPOD_COLD
#define FLEXAPOD_APART
#elif defined(__GNUC__) || defined(__clang__)  // clang-cl is the second only
#define FLEXAPOD_INLINE inline __attribute__((always_inline))
#define FLEXAPOD_FLAT __attribute__((flatten, noinline))  // with all that it calls inlined
#define FLEXAPOD_COLD __attribute__((noinline, cold))
#define FLEXAPOD_APART __attribute__((noinline))  // kept out of the functions that seldom need it
#else
#define FLEXAPOD_INLINE __forceinline
#define FLEXAPOD_FLAT
#define FLEXAPOD_COLD
#define FLEXAPOD_APART
#endif

#if (defined(__GNUC__) || defined(__clang__)) && !defined(FLEXAPOD_SANITIZE)
#define FLEXAPOD_UNROLL _Pragma("GCC unroll 16")
#else
#define FLEXAPOD_UNROLL
#endif

namespace flexapod {

template <class T> struct is_scalar : std::is_arithmetic<T> {};
template <class T>
concept Scalar = is_scalar<std::remove_cvref_t<T>>::value;

/// The type of a product of two scalars: double with Dual gives Dual.
template <class A, class B> using product_t = decltype(std::declval<A>() * std::declval<B>());

/// The type of a comparison: bool for double, a lane mask for packs.
template <class T> using mask_t = decltype(std::declval<T>() < std::declval<T>());

inline double sqrt(double x) { return std::sqrt(x); }
inline double rsqrt(double x) { return 1.0 / std::sqrt(x); }
inline double abs(double x) { return std::abs(x); }
inline double acos(double x) { return std::acos(x); }
inline double atan2(double y, double x) { return std::atan2(y, x); }
/// The angle, 0 to pi, of a vector with the parts x and y >= 0.
inline double upper_angle(double y, double x) { return std::atan2(y, x); }
inline double select(bool take_a, double a, double b) { return take_a ? a : b; }

inline bool any(bool condition) { return condition; }  // whether any lane is true

template <class T> T min(T a, T b) { return select(a < b, a, b); }
template <class T> T max(T a, T b) { return select(a > b, a, b); }
template <class T> T clamp(T x, T low, T high) { return min(max(x, low), high); }

}  // namespace flexapod
