// SPDX-License-Identifier: MIT
// Rows of a picture's colour in the form that OpenEXR writes.
#pragma once

#include <ImathBox.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "image/output_format.h"
#include "image/picture.h"

namespace afterglow {

/// Strips of rows as slices of a frame buffer: what the picture holds is lent straight from it, the other of floats and
/// halves is made strip by strip.
class ExrColorRows {
 public:
  /// `names`: channels for R, G, B, A; empty ones are not written.
  ExrColorRows(const Picture& picture, std::array<std::string, 4> names, SampleType type);

  static constexpr int kRows = 256;  ///< a multiple of every method's chunk height
  void add_channels(Imf::Header& header) const;
  /// Slices for rows [first, first + rows) of the data window, counted from its top.
  void add_slices(int first, int rows, Imf::FrameBuffer& buffer);
  /// Where the channels lie in lines of a file with this header: see ExrLineWriter.
  void find_places(const Imf::Header& header);
  /// One row of the data window, counted from its top, into such a line. Thread-safe.
  void put_row(int row, std::uint8_t* line);
  /// Says how many samples were held at ±65504, if any were: halves, and floats that DWA makes halves of.
  void warn_of_overflow(const Imf::Header& header, Diagnostics& diagnostics) const;

 private:
  const Picture& picture_;
  std::array<std::string, 4> names_;
  SampleType type_;
  std::array<std::size_t, 4> places_{};
  std::vector<std::uint16_t> halves_;
  std::vector<float> floats_;
  std::atomic<std::uint64_t> overflows_ = 0;
};

/// A picture's window as OpenEXR has it.
Imath::Box2i exr_window(const Rect& rect);

/// Sets compression and its level from the options: ZIP and level 1 by default, which is twice as fast as zlib's 4 and
/// makes files of the same size (exr_zip.h).
Result<void> set_compression(Imf::Header& header, const std::string& text);

}  // namespace afterglow
