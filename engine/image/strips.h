// SPDX-License-Identifier: MIT
// The display window as rows of samples in the form that a format without windows stores.
#pragma once

#include <cstddef>
#include <cstdint>

#include "image/picture.h"
#include "image/writer.h"

namespace afterglow {

struct OutputFormat;

struct StripForm {
  SampleType type = SampleType::uint8;  ///< integers are codes (uint10 and uint12 in 16 bits), floats scene-linear
  bool alpha = false;                   ///< four samples a pixel, else three
  bool dither = false;
  int dither_x = 0, dither_y = 0;      ///< where the upper left pixel lies in the noise
  const OutputSpace* space = nullptr;  ///< of integers; null: sRGB
  bool view = false;                   ///< Picture::view: the codes of null are not said to be sRGB

  std::size_t sample_bytes() const { return type == SampleType::uint8 ? 1 : type == SampleType::float32 ? 4 : 2; }
  std::size_t row_bytes(const Picture& picture) const {
    return static_cast<std::size_t>(picture.display_window.width) * (alpha ? 4 : 3) * sample_bytes();
  }
};

/// The form that this format takes for this picture.
StripForm strip_form(const Picture& picture, const OutputFormat& format, const WriteOptions& options);

/// Rows [first, first + rows) of the display window into `bytes`, on this thread.
void encode_rows(const Picture& picture, const StripForm& form, int first, int rows, std::uint8_t* bytes);
/// The same on several threads.
void encode_strip(const Picture& picture, const StripForm& form, int first, int rows, std::uint8_t* bytes);

}  // namespace afterglow
