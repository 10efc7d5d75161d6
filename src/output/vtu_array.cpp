#include "output/vtu_array.h"

#include <new>

#include "core/parallel.h"

namespace sphgeo {

namespace {

void write_u64(AtomicFile& file, std::uint64_t value) { file.write(&value, sizeof value); }

/// Wraps bytes into a zlib stream of one stored block: readable by any zlib, and as fast as a copy.
void write_stored_block(AtomicFile& file, const unsigned char* data, std::size_t bytes) {
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
  file.write(head, sizeof head);
  file.write(data, bytes);
  file.write(tail, sizeof tail);
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

void VtuArray::write_block_sizes(AtomicFile& file) const {
  const Index n = blocks();
  const Index last = count_ - std::max<Index>(n - 1, 0) * values_per_block();
  write_u64(file, static_cast<std::uint64_t>(n));
  write_u64(file, static_cast<std::uint64_t>(block_bytes));
  // The size of the last block when it is not a full one, else 0.
  const bool partial = n > 0 && last < values_per_block();
  write_u64(file, partial ? static_cast<std::uint64_t>(last) * value_bytes_ : 0);
  for (Index b = 0; b < n; ++b) {
    const std::uint64_t raw = static_cast<std::uint64_t>(values_in(b)) * value_bytes_;
    write_u64(file, deflated_.empty() ? raw + stored_overhead
                                      : deflated_[static_cast<std::size_t>(b)].size());
  }
}

void VtuArray::write(AtomicFile& file) const {
  if (blocked_) write_block_sizes(file);
  else write_u64(file, static_cast<std::uint64_t>(count_) * value_bytes_);
  for (const std::string& block : deflated_) file.write(block);
  if (!deflated_.empty()) return;
  std::vector<unsigned char> raw(static_cast<std::size_t>(block_bytes));
  for (Index b = 0; b < blocks(); ++b) {
    const Index n = values_in(b);
    const std::size_t bytes = static_cast<std::size_t>(n) * value_bytes_;
    fill_(b * values_per_block(), n, raw.data());
    if (blocked_) write_stored_block(file, raw.data(), bytes);
    else file.write(raw.data(), bytes);
  }
}

}  // namespace sphgeo
