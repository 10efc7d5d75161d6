#pragma once
// Hashes: random numbers that depend on a seed and an index only (not on order or threads), and a
// checksum of bytes.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace sphgeo {

/// Mixes all bits of x (a bijection of 64-bit integers: xor-shifts and odd multipliers).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93u;
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93u;
  x ^= x >> 32;
  return x;
}

/// A 64-bit random number for (seed, index).
constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t index) {
  return mix_bits(mix_bits(seed + 0x9e3779b97f4a7c15u) ^ mix_bits(index * 0x9e3779b97f4a7c15u + 1));
}

/// Uniform in [0, 1), a multiple of 2^-53.
constexpr double random_uniform(std::uint64_t seed, std::uint64_t index) {
  return static_cast<double>(random_bits(seed, index) >> 11) * 0x1p-53;
}

inline constexpr std::uint64_t fnv1a_start = 0xcbf29ce484222325u;

/// FNV-1a of raw memory, 64 bits. Pass the result of one call as `state` of the next to continue.
inline std::uint64_t fnv1a_bytes(const void* data, std::size_t bytes,
                                 std::uint64_t state = fnv1a_start) {
  const auto* p = static_cast<const unsigned char*>(data);
  for (std::size_t k = 0; k < bytes; ++k) state = (state ^ p[k]) * 0x100000001b3u;
  return state;
}

/// FNV-1a of a text.
constexpr std::uint64_t fnv1a(std::string_view text, std::uint64_t state = fnv1a_start) {
  for (const char c : text) state = (state ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return state;
}

/// Checksum of a large array, several bytes a cycle: FNV-1a over 64-bit words in four streams,
/// turned after each product: that carries a change only upwards, so that two flipped signs would
/// undo each other at the top. Each step is a bijection, so any change of a single word changes the
/// result.
inline std::uint64_t checksum(const void* data, std::size_t bytes) {
  const auto* p = static_cast<const unsigned char*>(data);
  std::uint64_t stream[4] = {fnv1a_start, fnv1a_start + 1, fnv1a_start + 2, fnv1a_start + 3};
  std::size_t k = 0;
  for (; k + sizeof stream <= bytes; k += sizeof stream)
    for (std::size_t s = 0; s < 4; ++s) {
      std::uint64_t word;
      std::memcpy(&word, p + k + 8 * s, sizeof word);
      stream[s] = std::rotl((stream[s] ^ word) * 0x100000001b3u, 29);
    }
  std::uint64_t sum = fnv1a_bytes(p + k, bytes - k, bytes);
  for (const std::uint64_t s : stream) sum = mix_bits(sum ^ s);
  return sum;
}

}  // namespace sphgeo
