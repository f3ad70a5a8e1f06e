// SPDX-License-Identifier: MIT
// A picture in 256 colours of its own, for GIF.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "image/pixel_layout.h"

namespace afterglow {

struct PalettePicture {
  std::vector<std::uint8_t> indices;        ///< row by row
  std::array<std::uint32_t, 256> colors{};  ///< 0xAARRGGBB; the last is transparent where the frame has alpha
};

/// Colours by median cut over a 5-bit histogram; blue noise hides the steps between them. Alpha below one half is
/// transparent. `frame` is "rgb24" or "rgba". The same frame gives the same bytes.
PalettePicture palette_picture(const PackedFrame& frame);

}  // namespace afterglow
