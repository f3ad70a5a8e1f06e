// SPDX-License-Identifier: MIT
#include "image/deflate.h"

#include <libdeflate.h>
#include <zlib.h>
#if defined(AFTERGLOW_ISAL)
#include <isa-l/igzip_lib.h>
#endif

#include <algorithm>
#include <new>
#include <vector>

namespace afterglow {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr int kFastLevel = 1;

}  // namespace

#if defined(AFTERGLOW_ISAL)
constexpr bool kHasFast = true;

/// ISA-L's level 2. Level 3 makes other bytes on processors with AVX-512; level 1 is no faster.
class Deflate::Fast {
 public:
  Fast() : tables_(ISAL_DEF_LVL2_DEFAULT) {}

  /// Within a zlib stream of its own, or as a piece of one. 0: no room.
  std::size_t pack(Bytes bytes, bool own_stream, bool last, std::span<std::uint8_t> packed) {
    isal_deflate_init(&state_);
    state_.level = 2;
    state_.level_buf = tables_.data();
    state_.level_buf_size = static_cast<std::uint32_t>(tables_.size());
    state_.gzip_flag = own_stream ? IGZIP_ZLIB : IGZIP_DEFLATE;
    state_.flush = last ? NO_FLUSH : FULL_FLUSH;  // which ends with a whole byte, and refers to nothing before it
    state_.end_of_stream = last ? 1 : 0;
    state_.next_in = const_cast<std::uint8_t*>(bytes.data());
    state_.avail_in = static_cast<std::uint32_t>(bytes.size());
    state_.next_out = packed.data();
    state_.avail_out = static_cast<std::uint32_t>(packed.size());
    if (isal_deflate(&state_) != COMP_OK || state_.avail_in > 0) return 0;
    const bool whole = last ? state_.internal_state.state == ZSTATE_END : state_.avail_out > 0;
    return whole ? state_.total_out : 0;
  }

 private:
  std::vector<std::uint8_t> tables_;
  isal_zstream state_;
};
#else
constexpr bool kHasFast = false;

class Deflate::Fast {
 public:
  std::size_t pack(Bytes, bool, bool, std::span<std::uint8_t>) { return 0; }
};
#endif

Deflate::Deflate(int level) {
  if (makes_pieces(level)) {
    fast_ = std::make_unique<Fast>();
  } else if (other_ = libdeflate_alloc_compressor(level); !other_) {
    throw std::bad_alloc();
  }
}

Deflate::~Deflate() { libdeflate_free_compressor(other_); }

bool Deflate::makes_pieces(int level) { return kHasFast && level == kFastLevel; }

std::size_t Deflate::bound(std::size_t bytes) {
  // ISA-L stores what would get longer: some bytes for each block, and those of head, end and sum.
  const std::size_t fast = bytes + bytes / 256 + 1024;
  return std::max(fast, libdeflate_zlib_compress_bound(nullptr, bytes));
}

std::size_t Deflate::stream(Bytes bytes, std::span<std::uint8_t> packed) {
  if (fast_) return fast_->pack(bytes, true, true, packed);
  return libdeflate_zlib_compress(other_, bytes.data(), bytes.size(), packed.data(), packed.size());
}

std::size_t Deflate::piece(Bytes bytes, bool last, std::span<std::uint8_t> packed) {
  return fast_ ? fast_->pack(bytes, false, last, packed) : 0;
}

std::uint32_t adler32_of(Bytes bytes) { return libdeflate_adler32(1, bytes.data(), bytes.size()); }

std::uint32_t adler32_of(std::uint32_t first, std::uint32_t second, std::size_t second_bytes) {
  return static_cast<std::uint32_t>(adler32_combine(first, second, static_cast<z_off_t>(second_bytes)));
}

}  // namespace afterglow
