#pragma once
// Short vectors of numbers for the pair loops: the only header with code for an instruction set.
//
// A pair function is written once as a template on its number type and instantiated with `Lanes`
// (one neighbor per lane) and with plain `double` (brute force). All operations here exist for
// both. Arithmetic uses vector extensions of the compiler; only what they lack is done by
// intrinsics, for AVX-512, AVX2, or neither. Results are the same for any number of threads, but
// may differ in the last bits between instruction sets.

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace sphgeo {

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
inline constexpr int lane_bytes = 64;
#elif defined(__AVX2__) && defined(__FMA__)
inline constexpr int lane_bytes = 32;
#else
inline constexpr int lane_bytes = 16;
#endif

/// Lanes that fit one register of this build.
template <class T>
inline constexpr int native_width = lane_bytes / static_cast<int>(sizeof(T));

/// A signed integer of the size of T.
template <class T>
using IntOf = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;

/// W numbers that are computed with at once.
template <class T, int W = native_width<T>>
struct Lanes {
  static constexpr int width = W;
  using value_type = T;
  // The attribute needs typedef: GCC ignores it on a dependent alias.
  typedef T Raw __attribute__((vector_size(W * sizeof(T))));
  typedef IntOf<T> Mask __attribute__((vector_size(W * sizeof(T))));

  Raw raw;

  Lanes() = default;
  Lanes(Raw v) : raw(v) {}
  /// The same number in all lanes; any arithmetic type, so that pair functions may write 2 * x.
  template <class S>
  requires std::is_arithmetic_v<S> Lanes(S s) : raw(static_cast<T>(s) - Raw{}) {}

  T operator[](int k) const { return raw[k]; }

  friend Lanes operator+(Lanes a, Lanes b) { return {a.raw + b.raw}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {a.raw - b.raw}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {a.raw * b.raw}; }
  friend Lanes operator/(Lanes a, Lanes b) { return {a.raw / b.raw}; }
  friend Lanes operator-(Lanes a) { return {-a.raw}; }
  Lanes& operator+=(Lanes b) { return *this = *this + b; }
  Lanes& operator-=(Lanes b) { return *this = *this - b; }
  Lanes& operator*=(Lanes b) { return *this = *this * b; }

  friend Mask operator<(Lanes a, Lanes b) { return a.raw < b.raw; }
  friend Mask operator>(Lanes a, Lanes b) { return a.raw > b.raw; }
  friend Mask operator<=(Lanes a, Lanes b) { return a.raw <= b.raw; }
  friend Mask operator>=(Lanes a, Lanes b) { return a.raw >= b.raw; }

  /// a where the mask is set, b elsewhere.
  friend Lanes select(Mask m, Lanes a, Lanes b) { return {m ? a.raw : b.raw}; }
};

/// Numbers of a pair function: a plain floating-point number or lanes.
template <class T>
struct ScalarOf {
  using type = T;
};
template <class T, int W>
struct ScalarOf<Lanes<T, W>> {
  using type = T;
};

// ---- plain numbers -----------------------------------------------------------------------------

template <std::floating_point T>
T select(bool m, T a, T b) {
  return m ? a : b;
}
/// The smaller; b if either is NaN. So `min(bound, x)` lets a NaN of x pass. Same for max.
template <std::floating_point T>
T min(T a, T b) {
  return a < b ? a : b;
}
template <std::floating_point T>
T max(T a, T b) {
  return a > b ? a : b;
}
template <std::floating_point T>
T sqrt(T a) {
  return std::sqrt(a);
}
template <std::floating_point T>
T abs(T a) {
  return std::fabs(a);
}
/// 1 / sqrt(a), to about the last bit.
template <std::floating_point T>
T rsqrt(T a) {
  return T(1) / std::sqrt(a);
}
/// 1 / a, to about the last bit.
template <std::floating_point T>
T reciprocal(T a) {
  return T(1) / a;
}

// ---- lanes -------------------------------------------------------------------------------------

namespace detail {
// A mask of all lanes. The unmasked AVX-512 intrinsics of GCC 12 warn about an uninitialized
// register of their own; with this constant the masked ones make the same instruction.
inline constexpr std::uint8_t all_8 = 0xff;
inline constexpr std::uint16_t all_16 = 0xffff;

template <class T, int W>
inline constexpr bool is_512 = lane_bytes == 64 && W * sizeof(T) == 64;
template <class T, int W>
inline constexpr bool is_256 = lane_bytes >= 32 && W * sizeof(T) == 32;
}  // namespace detail

template <class T, int W>
Lanes<T, W> min(Lanes<T, W> a, Lanes<T, W> b) {
#if defined(__AVX512F__)
  if constexpr (std::same_as<T, float> && detail::is_512<T, W>)
    return {_mm512_maskz_min_ps(detail::all_16, a.raw, b.raw)};
  else if constexpr (detail::is_512<T, W>)
    return {_mm512_maskz_min_pd(detail::all_8, a.raw, b.raw)};
  else
#endif
#if defined(__AVX2__)
      if constexpr (std::same_as<T, float> && detail::is_256<T, W>)
    return {_mm256_min_ps(a.raw, b.raw)};
  else if constexpr (detail::is_256<T, W>) return {_mm256_min_pd(a.raw, b.raw)};
  else
#endif
    return select(a < b, a, b);
}

template <class T, int W>
Lanes<T, W> max(Lanes<T, W> a, Lanes<T, W> b) {
#if defined(__AVX512F__)
  if constexpr (std::same_as<T, float> && detail::is_512<T, W>)
    return {_mm512_maskz_max_ps(detail::all_16, a.raw, b.raw)};
  else if constexpr (detail::is_512<T, W>)
    return {_mm512_maskz_max_pd(detail::all_8, a.raw, b.raw)};
  else
#endif
#if defined(__AVX2__)
      if constexpr (std::same_as<T, float> && detail::is_256<T, W>)
    return {_mm256_max_ps(a.raw, b.raw)};
  else if constexpr (detail::is_256<T, W>) return {_mm256_max_pd(a.raw, b.raw)};
  else
#endif
    return select(a > b, a, b);
}

template <class T, int W>
Lanes<T, W> sqrt(Lanes<T, W> a) {
#if defined(__AVX512F__)
  if constexpr (std::same_as<T, float> && detail::is_512<T, W>)
    return {_mm512_maskz_sqrt_ps(detail::all_16, a.raw)};
  else if constexpr (detail::is_512<T, W>) return {_mm512_maskz_sqrt_pd(detail::all_8, a.raw)};
  else
#endif
#if defined(__AVX2__)
      if constexpr (std::same_as<T, float> && detail::is_256<T, W>)
    return {_mm256_sqrt_ps(a.raw)};
  else if constexpr (detail::is_256<T, W>) return {_mm256_sqrt_pd(a.raw)};
  else
#endif
  {
    Lanes<T, W> b;
    for (int k = 0; k < W; ++k) b.raw[k] = std::sqrt(a.raw[k]);
    return b;
  }
}

template <class T, int W>
Lanes<T, W> abs(Lanes<T, W> a) {
  return max(a, -a);
}

/// 1 / sqrt(a), to about the last bit (an estimate of 12 or 14 bits and Newton steps). Wants a > 0.
template <class T, int W>
Lanes<T, W> rsqrt(Lanes<T, W> a) {
  using L = Lanes<T, W>;
  [[maybe_unused]] const auto newton = [&](L y) { return y + y * T(0.5) * (T(1) - a * y * y); };
#if defined(__AVX512F__)
  if constexpr (std::same_as<T, float> && detail::is_512<T, W>)
    return newton(L(_mm512_maskz_rsqrt14_ps(detail::all_16, a.raw)));
  else if constexpr (detail::is_512<T, W>)
    return newton(newton(L(_mm512_maskz_rsqrt14_pd(detail::all_8, a.raw))));
  else
#endif
#if defined(__AVX2__)
      if constexpr (std::same_as<T, float> && detail::is_256<T, W>)
    return newton(L(_mm256_rsqrt_ps(a.raw)));
  else
#endif
    return L(T(1)) / sqrt(a);
}

/// 1 / a, to about the last bit. Wants a finite number other than zero.
template <class T, int W>
Lanes<T, W> reciprocal(Lanes<T, W> a) {
  using L = Lanes<T, W>;
  [[maybe_unused]] const auto newton = [&](L y) { return y + y * (T(1) - a * y); };
#if defined(__AVX512F__)
  if constexpr (std::same_as<T, float> && detail::is_512<T, W>)
    return newton(L(_mm512_maskz_rcp14_ps(detail::all_16, a.raw)));
  else if constexpr (detail::is_512<T, W>)
    return newton(newton(L(_mm512_maskz_rcp14_pd(detail::all_8, a.raw))));
  else
#endif
#if defined(__AVX2__)
      if constexpr (std::same_as<T, float> && detail::is_256<T, W>)
    return newton(L(_mm256_rcp_ps(a.raw)));
  else
#endif
    return L(T(1)) / a;
}

namespace detail {
template <int From, class Raw, int... K>
auto part(Raw a, std::integer_sequence<int, K...>) {
  return __builtin_shufflevector(a, a, (From + K)...);
}
}  // namespace detail

/// Sum of all lanes, by halves: lane k and lane k + W/2 first.
template <class T, int W>
T sum(Lanes<T, W> a) {
  if constexpr (W == 2) {
    return a.raw[0] + a.raw[1];
  } else {
    constexpr auto half = std::make_integer_sequence<int, W / 2>{};
    return sum(Lanes<T, W / 2>(detail::part<0>(a.raw, half) + detail::part<W / 2>(a.raw, half)));
  }
}

// ---- lengths -----------------------------------------------------------------------------------

/// 1 / sqrt(r2); a finite large number at r2 = 0, so that zero vectors have the direction zero.
template <class N>
N inverse_length(N r2) {
  using T = typename ScalarOf<N>::type;
  return rsqrt(max(N(sizeof(T) == 4 ? T(1e-30) : T(1e-200)), r2));
}

/// sqrt(r2), exactly 0 at 0. Shares its work with inverse_length of the same number.
template <class N>
N length(N r2) {
  return r2 * inverse_length(r2);
}

// ---- transposing load --------------------------------------------------------------------------

/// Numbers in one record.
inline constexpr int record_size = 8;

/// Loads one record of 8 numbers per lane and transposes them in registers: out[f] holds number f
/// of the records that start at base + offset[0], base + offset[1], ... Records are aligned to
/// their size. Hardware gathers would take three to four times as long. The lanes come in an order
/// of their own, the same for all f.
template <class T>
inline void load_records(const T* base, const std::uint32_t* offset, Lanes<T>* out) {
  constexpr int width = native_width<T>;
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
  if constexpr (std::same_as<T, float>) {
    // Record k in the lower half of a register, record k + 8 in the upper.
    const auto two = [&](int k) {
      return _mm512_maskz_insertf32x8(detail::all_16,
                                      _mm512_castps256_ps512(_mm256_load_ps(base + offset[k])),
                                      _mm256_load_ps(base + offset[k + 8]), 1);
    };
    // Transposes four records; quarters 0 and 2 of v[f] hold number f, quarters 1 and 3 f + 4.
    const auto four = [&](int k, __m512* v) {
      const __m512 a = two(k), b = two(k + 1), c = two(k + 2), d = two(k + 3);
      const __m512 ab_lo = _mm512_maskz_unpacklo_ps(detail::all_16, a, b);
      const __m512 ab_hi = _mm512_maskz_unpackhi_ps(detail::all_16, a, b);
      const __m512 cd_lo = _mm512_maskz_unpacklo_ps(detail::all_16, c, d);
      const __m512 cd_hi = _mm512_maskz_unpackhi_ps(detail::all_16, c, d);
      v[0] = _mm512_maskz_shuffle_ps(detail::all_16, ab_lo, cd_lo, 0x44);
      v[1] = _mm512_maskz_shuffle_ps(detail::all_16, ab_lo, cd_lo, 0xee);
      v[2] = _mm512_maskz_shuffle_ps(detail::all_16, ab_hi, cd_hi, 0x44);
      v[3] = _mm512_maskz_shuffle_ps(detail::all_16, ab_hi, cd_hi, 0xee);
    };
    __m512 v[4], w[4];
    four(0, v);
    four(4, w);
    for (int f = 0; f < 4; ++f) {
      out[f].raw = _mm512_maskz_shuffle_f32x4(detail::all_16, v[f], w[f], 0x88);
      out[f + 4].raw = _mm512_maskz_shuffle_f32x4(detail::all_16, v[f], w[f], 0xdd);
    }
  } else {
    // Likewise, four numbers of records k and k + 4 at a time.
    const auto two = [&](int k, int half) {
      return _mm512_maskz_insertf64x4(
          detail::all_8, _mm512_castpd256_pd512(_mm256_load_pd(base + offset[k] + half)),
          _mm256_load_pd(base + offset[k + 4] + half), 1);
    };
    for (int half = 0; half < 8; half += 4) {
      const __m512d a = two(0, half), b = two(1, half), c = two(2, half), d = two(3, half);
      const __m512d ab_lo = _mm512_maskz_unpacklo_pd(detail::all_8, a, b);
      const __m512d ab_hi = _mm512_maskz_unpackhi_pd(detail::all_8, a, b);
      const __m512d cd_lo = _mm512_maskz_unpacklo_pd(detail::all_8, c, d);
      const __m512d cd_hi = _mm512_maskz_unpackhi_pd(detail::all_8, c, d);
      out[half + 0].raw = _mm512_maskz_shuffle_f64x2(detail::all_8, ab_lo, cd_lo, 0x88);
      out[half + 1].raw = _mm512_maskz_shuffle_f64x2(detail::all_8, ab_hi, cd_hi, 0x88);
      out[half + 2].raw = _mm512_maskz_shuffle_f64x2(detail::all_8, ab_lo, cd_lo, 0xdd);
      out[half + 3].raw = _mm512_maskz_shuffle_f64x2(detail::all_8, ab_hi, cd_hi, 0xdd);
    }
  }
#elif defined(__AVX2__) && defined(__FMA__)
  if constexpr (std::same_as<T, float>) {
    const auto two = [&](int k, int half) {
      return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(base + offset[k] + half)),
                                  _mm_load_ps(base + offset[k + 1] + half), 1);
    };
    for (int half = 0; half < 8; half += 4) {
      const __m256 a = two(0, half), b = two(2, half), c = two(4, half), d = two(6, half);
      const __m256 ab_lo = _mm256_unpacklo_ps(a, b), ab_hi = _mm256_unpackhi_ps(a, b);
      const __m256 cd_lo = _mm256_unpacklo_ps(c, d), cd_hi = _mm256_unpackhi_ps(c, d);
      out[half + 0].raw = _mm256_shuffle_ps(ab_lo, cd_lo, 0x44);
      out[half + 1].raw = _mm256_shuffle_ps(ab_lo, cd_lo, 0xee);
      out[half + 2].raw = _mm256_shuffle_ps(ab_hi, cd_hi, 0x44);
      out[half + 3].raw = _mm256_shuffle_ps(ab_hi, cd_hi, 0xee);
    }
  } else {
    const auto two = [&](int k, int pair) {
      return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(base + offset[k] + pair)),
                                  _mm_load_pd(base + offset[k + 1] + pair), 1);
    };
    for (int pair = 0; pair < 8; pair += 2) {
      const __m256d a = two(0, pair), b = two(2, pair);
      out[pair].raw = _mm256_unpacklo_pd(a, b);
      out[pair + 1].raw = _mm256_unpackhi_pd(a, b);
    }
  }
#else
  for (unsigned f = 0; f < record_size; ++f) {
    std::array<T, width> column{};
    for (std::size_t k = 0; k < width; ++k) column[k] = base[offset[k] + f];
    out[f].raw = std::bit_cast<typename Lanes<T>::Raw>(column);
  }
#endif
  static_assert(width >= 2);
}

}  // namespace sphgeo
