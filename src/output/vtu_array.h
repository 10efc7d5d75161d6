#pragma once
// The arrays of a .vtu file in their appended form; used by vtu.cpp only.

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// One array of numbers that knows how many bytes it takes in the file before it is stored, so that
/// the offsets in the XML head are right, and all threads can fill their parts of the file.
class VtuArray {
 public:
  /// `fill(first, count, out)` writes the values first .. first+count-1.
  template <class T>
  static VtuArray make(std::string head, Index count, bool compress,
                       std::function<void(Index, Index, T*)> fill) {
    VtuArray a;
    a.head_ = std::move(head);
    a.value_bytes_ = sizeof(T);
    a.count_ = count;
    a.fill_ = [fill = std::move(fill)](Index first, Index n, unsigned char* out) {
      fill(first, n, reinterpret_cast<T*>(out));
    };
    a.blocked_ = compress;
    if (compress && std::is_integral_v<T>) a.deflate_blocks();
    return a;
  }

  /// The attributes type, Name, ... of the XML element.
  const std::string& head() const { return head_; }
  /// Bytes in the appended section, sizes included.
  std::uint64_t bytes() const;
  /// Writes them to `to`, from all threads.
  void store(unsigned char* to) const;

 private:
  Index blocks() const { return (count_ + values_per_block() - 1) / values_per_block(); }
  Index values_per_block() const { return block_bytes / static_cast<Index>(value_bytes_); }
  Index values_in(Index block) const {
    return std::min(values_per_block(), count_ - block * values_per_block());
  }
  void deflate_blocks();
  unsigned char* store_block_sizes(unsigned char* to) const;

  /// A multiple of all value sizes that fits one stored deflate block (at most 65535 bytes).
  static constexpr Index block_bytes = 65520;
  /// zlib's head (2), the head of one stored block (5) and the checksum (4).
  static constexpr std::uint64_t stored_overhead = 11;

  std::string head_;
  std::size_t value_bytes_ = 1;
  Index count_ = 0;
  bool blocked_ = false;
  std::function<void(Index, Index, unsigned char*)> fill_;
  std::vector<std::string> deflated_;  ///< by block; empty: stored blocks
};

}  // namespace sphgeo
