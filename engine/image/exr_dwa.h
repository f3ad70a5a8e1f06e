// SPDX-License-Identifier: MIT
// OpenEXR's DWAA and DWAB, as its library reads them, for pictures of R, G, B and A as half floats: colour by blocks of
// cosines (exr_dct.h), alpha without loss.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include "image/exr_dct.h"
#include "image/exr_packer.h"
#include "image/exr_zip.h"

namespace afterglow {

/// Whether ExrDwa can pack its lines.
bool has_dwa_lines(const Imf::Header& header);

class ExrDwa : public ExrPacker {
 public:
  /// Its dwaCompressionLevel() and zipCompressionLevel() are taken.
  explicit ExrDwa(const Imf::Header& header);

  std::span<const std::uint8_t> run(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& packed) override;

 private:
  /// Of the lines of a chunk.
  void pack_colour(std::span<const std::uint8_t> bytes, int lines);
  void pack_alpha(std::span<const std::uint8_t> bytes, int lines);

  int width_;
  bool has_alpha_;
  DctEncoder dct_;
  ExrZip zip_;
  std::vector<std::uint16_t> ac_, dc_;
  std::size_t ac_count_ = 0;
  std::vector<std::uint8_t> alpha_, runs_;
};

}  // namespace afterglow
