// SPDX-License-Identifier: MIT
// Bytes packed as zlib does (RFC 1950, 1951), by faster libraries. Level 1 is ISA-L's where the program was built with
// it (AFTERGLOW_ISAL): 1.6 to 3.6 times as fast as libdeflate's level 1, 2 to 9 % longer. All else is libdeflate's, in
// half of zlib's time or less. The same bytes on every processor of a kind, however many threads there are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

struct libdeflate_compressor;

namespace afterglow {

/// One thread's; keeps its memory from call to call. No call takes more than 2 GiB.
class Deflate {
 public:
  explicit Deflate(int level);  ///< 0 to 9, as zlib's. May throw std::bad_alloc
  ~Deflate();
  Deflate(const Deflate&) = delete;
  Deflate& operator=(const Deflate&) = delete;

  /// Bytes that are always enough for what `bytes` of them become, as a stream or as a piece, at every level.
  static std::size_t bound(std::size_t bytes);
  /// A zlib stream of `bytes`. Returns how long it is; 0: it does not fit into `packed`.
  std::size_t stream(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> packed);

  /// Whether this level makes pieces, so that several threads can make one stream: kStreamHead, the pieces one after
  /// the other, and the Adler-32 of all bytes, the highest byte first.
  static bool makes_pieces(int level);
  /// A piece of a stream. Returns as `stream`.
  std::size_t piece(std::span<const std::uint8_t> bytes, bool last, std::span<std::uint8_t> packed);

 private:
  class Fast;
  std::unique_ptr<Fast> fast_;
  libdeflate_compressor* other_ = nullptr;  ///< where `fast_` is null
};

/// A window of 32 KiB, the fastest way.
inline constexpr std::uint8_t kStreamHead[2] = {0x78, 0x01};

/// Adler-32 of bytes; of two parts whose sums are known, one behind the other.
std::uint32_t adler32_of(std::span<const std::uint8_t> bytes);
std::uint32_t adler32_of(std::uint32_t first, std::uint32_t second, std::size_t second_bytes);

}  // namespace afterglow
