// SPDX-License-Identifier: MIT
// OpenEXR's ZIP and ZIPS, as its documentation of the file layout has them: the bytes at even places and those at odd
// ones are put apart, each byte becomes its difference from the one before, and all of it is deflated. By libdeflate,
// which takes half of zlib's time or less.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

struct libdeflate_compressor;
struct libdeflate_decompressor;

namespace afterglow {

/// One thread's; keeps its memory from chunk to chunk.
class ExrUnzip {
 public:
  ExrUnzip();
  ~ExrUnzip();
  ExrUnzip(const ExrUnzip&) = delete;
  ExrUnzip& operator=(const ExrUnzip&) = delete;

  /// `bytes` is as long as the chunk was before. False when `packed` is damaged, or makes another length.
  bool run(std::span<const std::uint8_t> packed, std::span<std::uint8_t> bytes);

 private:
  libdeflate_decompressor* inflate_;
  std::vector<std::uint8_t> apart_;
};

/// The other way. One thread's.
class ExrZip {
 public:
  explicit ExrZip(int level);  ///< 0 to 9, as zlib's
  ~ExrZip();
  ExrZip(const ExrZip&) = delete;
  ExrZip& operator=(const ExrZip&) = delete;

  /// What a file stores for a chunk of these bytes: `packed`, which is made as long as that is, or the bytes themselves
  /// where packing makes them no shorter.
  std::span<const std::uint8_t> run(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed);

 private:
  libdeflate_compressor* deflate_;
  std::vector<std::uint8_t> apart_, differences_;
};

}  // namespace afterglow
