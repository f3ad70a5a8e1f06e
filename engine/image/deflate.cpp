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

  /// 0: no room.
  std::size_t pack(Bytes bytes, bool last, std::span<std::uint8_t> packed) {
    // Without history, ISA-L (2.30 to 2.31.1, and its sources of 2026) hashes its own address in place of the third
    // byte: other bytes in one of some hundred runs. So a stored block holds the first bytes, and they are its history.
    // What is shorter never comes there.
    constexpr std::size_t kFirst = 4, kShort = 16;
    const std::size_t first = bytes.size() > kShort ? kFirst : 0;
    std::size_t at = 0;
    if (first > 0) {
      const std::uint8_t head[] = {0, kFirst, 0, static_cast<std::uint8_t>(~kFirst), 0xff};
      if (packed.size() < sizeof head + first) return 0;
      std::copy_n(head, sizeof head, packed.data());
      std::copy_n(bytes.data(), first, packed.data() + sizeof head);
      at = sizeof head + first;
    }
    isal_deflate_init(&state_);
    state_.level = 2;
    state_.level_buf = tables_.data();
    state_.level_buf_size = static_cast<std::uint32_t>(tables_.size());
    state_.gzip_flag = IGZIP_DEFLATE;
    state_.flush = last ? NO_FLUSH : FULL_FLUSH;  // which ends with a whole byte, and refers to nothing before it
    state_.end_of_stream = last ? 1 : 0;
    if (isal_deflate_set_dict(&state_, const_cast<std::uint8_t*>(bytes.data()), static_cast<std::uint32_t>(first)) !=
        COMP_OK)
      return 0;
    state_.next_in = const_cast<std::uint8_t*>(bytes.data()) + first;
    state_.avail_in = static_cast<std::uint32_t>(bytes.size() - first);
    state_.next_out = packed.data() + at;
    state_.avail_out = static_cast<std::uint32_t>(packed.size() - at);
    if (isal_deflate(&state_) != COMP_OK || state_.avail_in > 0) return 0;
    const bool whole = last ? state_.internal_state.state == ZSTATE_END : state_.avail_out > 0;
    return whole ? at + state_.total_out : 0;
  }

 private:
  std::vector<std::uint8_t> tables_;
  isal_zstream state_;
};
#else
constexpr bool kHasFast = false;

class Deflate::Fast {
 public:
  std::size_t pack(Bytes, bool, std::span<std::uint8_t>) { return 0; }
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
  if (!fast_) return libdeflate_zlib_compress(other_, bytes.data(), bytes.size(), packed.data(), packed.size());
  constexpr std::size_t kAround = sizeof kStreamHead + 4;
  if (packed.size() <= kAround) return 0;
  std::ranges::copy(kStreamHead, packed.begin());
  const std::size_t length = piece(bytes, true, packed.subspan(sizeof kStreamHead, packed.size() - kAround));
  if (length == 0) return 0;
  const std::uint32_t sum = adler32_of(bytes);
  std::uint8_t* const tail = packed.data() + sizeof kStreamHead + length;
  for (int i = 0; i < 4; ++i) tail[i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
  return length + kAround;
}

std::size_t Deflate::piece(Bytes bytes, bool last, std::span<std::uint8_t> packed) {
  return fast_ ? fast_->pack(bytes, last, packed) : 0;
}

std::uint32_t adler32_of(Bytes bytes) { return libdeflate_adler32(1, bytes.data(), bytes.size()); }

std::uint32_t adler32_of(std::uint32_t first, std::uint32_t second, std::size_t second_bytes) {
  return static_cast<std::uint32_t>(adler32_combine(first, second, static_cast<z_off_t>(second_bytes)));
}

}  // namespace afterglow
