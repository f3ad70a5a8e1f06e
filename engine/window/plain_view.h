// SPDX-License-Identifier: MIT
// Pictures in the way in which most are looked at, nearest pixels or their means as sRGB codes, made by the processor:
// drivers on the CPU take several times as long for a shader that does the same, since they read pixels block by block.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry.h"

namespace afterglow {

/// What is looked at, and where on the target it lies.
struct PlainView {
  const std::byte* pixels = nullptr;  ///< RGBA floats; the first row's
  std::size_t row_pitch = 0;          ///< bytes from one row to the next
  bool half = false;                  ///< they are half floats
  bool means = false;                 ///< of all that a pixel of the target covers, by area; else the nearest
  bool blue_first = false;            ///< of the target: blue, green, red, alpha; else red first
  Size size;                          ///< of the image
  Size picture;                       ///< that `scale` is about
  std::array<float, 2> origin{};      ///< of the picture, in pixels of the target
  float scale = 1;                    ///< pixels of the target for each of the picture
  float gain = 1;                     ///< of the exposure
};

/// Codes of these pixels of the target, four bytes each, row by row without gaps; alpha is 255. The same pixels of the
/// image as view.frag takes, and codes that differ from its own at most where two are nearly equally near. NaN counts
/// as 0.
void write_plain_view(const PlainView& view, const Rect& pixels, std::byte* codes);

}  // namespace afterglow
