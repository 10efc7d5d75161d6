#include "output/vtu_array.h"

#include <memory>
#include <new>

#include "core/parallel.h"

namespace sphgeo {

namespace {

/// Returns the place behind it.
unsigned char* store_u64(unsigned char* to, std::uint64_t value) {
  std::memcpy(to, &value, sizeof value);
  return to + sizeof value;
}

/// Wraps bytes into a zlib stream of one stored block: readable by any zlib, and as fast as a copy.
void store_block(unsigned char* to, const unsigned char* data, std::size_t bytes) {
  const auto length = static_cast<std::uint16_t>(bytes);
  const auto inverse = static_cast<std::uint16_t>(~length);
  const unsigned char head[7] = {0x78,
                                 0x01,
                                 0x01,
                                 static_cast<unsigned char>(length & 0xff),
                                 static_cast<unsigned char>(length >> 8),
                                 static_cast<unsigned char>(inverse & 0xff),
                                 static_cast<unsigned char>(inverse >> 8)};
  const auto sum =
      static_cast<std::uint32_t>(adler32(adler32(0, nullptr, 0), data, static_cast<uInt>(bytes)));
  const unsigned char tail[4] = {
      static_cast<unsigned char>(sum >> 24), static_cast<unsigned char>(sum >> 16),
      static_cast<unsigned char>(sum >> 8), static_cast<unsigned char>(sum)};
  std::memcpy(to, head, sizeof head);
  std::memcpy(to + sizeof head, data, bytes);
  std::memcpy(to + sizeof head + bytes, tail, sizeof tail);
}

}  // namespace

std::uint64_t VtuArray::bytes() const {
  const std::uint64_t raw = static_cast<std::uint64_t>(count_) * value_bytes_;
  if (!blocked_) return sizeof(std::uint64_t) + raw;
  const auto n = static_cast<std::uint64_t>(blocks());
  std::uint64_t total = (3 + n) * sizeof(std::uint64_t);
  if (deflated_.empty()) return total + raw + n * stored_overhead;
  for (const std::string& block : deflated_) total += block.size();
  return total;
}

void VtuArray::deflate_blocks() {
  deflated_.resize(static_cast<std::size_t>(blocks()));
  // Blocks are independent, so the bytes do not depend on the number of threads.
  parallel_blocks(blocks(), 1, [&](Index b, Index, Index) {
    std::vector<unsigned char> raw(static_cast<std::size_t>(block_bytes));
    const Index n = values_in(b);
    fill_(b * values_per_block(), n, raw.data());
    const auto size = static_cast<uLong>(static_cast<std::size_t>(n) * value_bytes_);
    uLongf out_size = compressBound(size);
    std::string& out = deflated_[static_cast<std::size_t>(b)];
    out.resize(out_size);
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &out_size, raw.data(), size,
                  Z_BEST_SPEED) != Z_OK)
      throw std::bad_alloc();  // the only way in which it fails here
    out.resize(out_size);
    out.shrink_to_fit();
  });
}

unsigned char* VtuArray::store_block_sizes(unsigned char* to) const {
  const Index n = blocks();
  const Index last = count_ - std::max<Index>(n - 1, 0) * values_per_block();
  to = store_u64(to, static_cast<std::uint64_t>(n));
  to = store_u64(to, static_cast<std::uint64_t>(block_bytes));
  // The size of the last block when it is not a full one, else 0.
  const bool partial = n > 0 && last < values_per_block();
  to = store_u64(to, partial ? static_cast<std::uint64_t>(last) * value_bytes_ : 0);
  for (Index b = 0; b < n; ++b) {
    const std::uint64_t raw = static_cast<std::uint64_t>(values_in(b)) * value_bytes_;
    to = store_u64(to, deflated_.empty() ? raw + stored_overhead
                                         : deflated_[static_cast<std::size_t>(b)].size());
  }
  return to;
}

void VtuArray::store(unsigned char* to) const {
  to = blocked_ ? store_block_sizes(to)
                : store_u64(to, static_cast<std::uint64_t>(count_) * value_bytes_);
  if (!deflated_.empty()) {
    std::vector<unsigned char*> at;
    for (const std::string& block : deflated_) {
      at.push_back(to);
      to += block.size();
    }
    parallel_blocks(blocks(), 1, [&](Index b, Index, Index) {
      const std::string& block = deflated_[static_cast<std::size_t>(b)];
      std::memcpy(at[static_cast<std::size_t>(b)], block.data(), block.size());
    });
    return;
  }
  const Index stride = block_bytes + (blocked_ ? static_cast<Index>(stored_overhead) : 0);
  parallel_blocks(blocks(), 1, [&](Index b, Index, Index) {
    // Not filled in place: there the values are not aligned.
    const auto raw = std::make_unique_for_overwrite<unsigned char[]>(block_bytes);
    const Index n = values_in(b);
    const std::size_t bytes = static_cast<std::size_t>(n) * value_bytes_;
    fill_(b * values_per_block(), n, raw.get());
    if (blocked_) store_block(to + b * stride, raw.get(), bytes);
    else std::memcpy(to + b * stride, raw.get(), bytes);
  });
}

}  // namespace sphgeo
