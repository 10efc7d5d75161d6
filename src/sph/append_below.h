#pragma once
// Compressed stores: of the lanes of a register, those that pass a test, one behind the other.

#include <bit>
#include <cstdint>

#include "sph/lanes.h"

namespace sphgeo {

/// Lanes of 32-bit integers beside lanes of float.
using FloatLanes = Lanes<float>;
using IntLanes = FloatLanes::Mask;

#if defined(__AVX2__) && !defined(__AVX512F__)
namespace detail {
// For each set of kept lanes the lanes to move to the front, 4 bits each.
constexpr std::array<std::uint32_t, 256> make_front_lanes() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t kept = 0; kept < 256; ++kept) {
    std::uint32_t place = 0;
    for (std::uint32_t lane = 0; lane < 8; ++lane)
      if (kept >> lane & 1) table[kept] |= lane << (4 * place++);
  }
  return table;
}
inline constexpr auto front_lanes = make_front_lanes();
}  // namespace detail
#endif

/// Appends to out, in order, the values of the lanes where distance < limit and value != excluded;
/// returns the new end. Writes up to a full register past it.
inline std::uint32_t* append_below(std::uint32_t* out, IntLanes values, FloatLanes distance,
                                   FloatLanes limit, std::int32_t excluded) {
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
  // Compressing in the register and storing all of it: compressing stores are slow on some
  // machines.
  const auto v = std::bit_cast<__m512i>(values);
  const __mmask16 kept = _mm512_mask_cmplt_ps_mask(
      _mm512_cmpneq_epi32_mask(v, _mm512_set1_epi32(excluded)), distance.raw, limit.raw);
  _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(kept, v));
  return out + std::popcount(static_cast<std::uint32_t>(kept));
#else
  const IntLanes kept = (distance < limit) & (values != excluded);
#if defined(__AVX2__) && defined(__FMA__)
  const auto mask = static_cast<std::uint32_t>(_mm256_movemask_ps(std::bit_cast<__m256>(kept)));
  const __m256i shifts = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
  const __m256i lanes =
      _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(detail::front_lanes[mask])), shifts);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                      _mm256_permutevar8x32_epi32(std::bit_cast<__m256i>(values), lanes));
  return out + std::popcount(mask);
#else
  for (int k = 0; k < FloatLanes::width; ++k) {
    *out = static_cast<std::uint32_t>(values[k]);
    out += kept[k] != 0;
  }
  return out;
#endif
#endif
}

}  // namespace sphgeo
