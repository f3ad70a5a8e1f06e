// SPDX-License-Identifier: MIT
// An EXR of one part that is stored by ZIP, ZIPS, DWAA or DWAB, chunk by chunk: OpenEXR writes the header, the lines
// are packed here (exr_zip.h, exr_dwa.h), on several threads.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "image/exr_packer.h"
#include "image/output_file.h"

namespace afterglow {

/// Whether ExrLineWriter can: lines of ZIP or ZIPS from the top down, no channel sub-sampled; those of DWAA and DWAB
/// where has_dwa_lines().
bool can_pack_lines(const Imf::Header& header);
/// Bytes of a line before the samples of this channel.
std::size_t channel_place(const Imf::Header& header, const std::string& name);

/// Failures of the file are found in it. Not thread-safe.
class ExrLineWriter {
 public:
  /// Writes the header; its levels of compression are taken. `out` is at its beginning, and outlives this. Throws what
  /// OpenEXR throws.
  ExrLineWriter(const Imf::Header& header, OutputFile& out);

  /// Writes line `y`, counted from the top of the data window, as the file holds it: the samples of each channel one
  /// behind the other, channels in the order of their names. Called on several threads.
  using FillLine = std::function<void(int y, std::uint8_t* line)>;
  /// The next `count` lines: a multiple of the lines of a chunk, but for the last ones.
  void write(int count, const FillLine& fill);
  /// After the last line.
  void finish();

 private:
  struct Chunk {
    std::vector<std::uint8_t> bytes, packed;
    std::span<const std::uint8_t> stored;  ///< one of them
  };
  void pack(int number, Chunk& chunk, ExrPacker& packer, const FillLine& fill) const;
  int lines_of(int chunk) const;

  OutputFile& out_;
  int top_, height_, lines_;  ///< of the data window; of a chunk
  std::size_t line_bytes_ = 0;
  std::uint64_t offsets_at_ = 0;
  std::vector<std::uint64_t> offsets_;               ///< of the chunks so far
  std::vector<Chunk> together_;                      ///< whose packed bytes are held
  std::vector<std::unique_ptr<ExrPacker>> packers_;  ///< one a thread
};

}  // namespace afterglow
