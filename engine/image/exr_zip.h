// SPDX-License-Identifier: MIT
// OpenEXR's ZIP and ZIPS, as its documentation of the file layout has them: the bytes at even places and those at odd
// ones are put apart, each byte becomes its difference from the one before, and all of it is deflated.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/deflate.h"
#include "image/exr_packer.h"

struct libdeflate_decompressor;

namespace afterglow {

/// One thread's; keeps its memory from chunk to chunk.
class ExrUnzip {
 public:
  ExrUnzip();
  ~ExrUnzip();
  ExrUnzip(const ExrUnzip&) = delete;
  ExrUnzip& operator=(const ExrUnzip&) = delete;

  /// `bytes` is as long as the chunk was before, and so is `apart`, room to work in. False when `packed` is damaged, or
  /// makes another length.
  bool run(std::span<const std::uint8_t> packed, std::span<std::uint8_t> bytes, std::span<std::uint8_t> apart);

 private:
  libdeflate_decompressor* inflate_;
};

/// The other way. One thread's.
class ExrZip : public ExrPacker {
 public:
  explicit ExrZip(int level) : deflate_(level) {}  ///< 0 to 9, as zlib's

  std::span<const std::uint8_t> run(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed) override;
  /// The same, behind what `packed` holds, and also where it makes the bytes longer.
  void append(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed);
  /// Deflated alone, neither put apart nor made differences, behind what `packed` holds.
  void append_plain(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed);

 private:
  std::span<const std::uint8_t> differences(std::span<const std::uint8_t> bytes);

  Deflate deflate_;
  std::vector<std::uint8_t> apart_, differences_;
};

}  // namespace afterglow
