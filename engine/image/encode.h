// SPDX-License-Identifier: MIT
// Scene-linear floats to what files store: half floats, and code values for displays.
#pragma once

#include <cstdint>

#include "image/picture.h"

namespace afterglow {

/// Half floats of `count` floats, round to nearest even; finite values beyond ±65504 and infinities are held there.
/// Returns how many were.
std::uint64_t to_half(const float* values, std::uint16_t* halves, std::size_t count);

/// Row `y` of the display window, counted from its top: RGBA pixels of `picture`, and (0, 0, 0, `padding_alpha`) where
/// it has none.
void display_row(const Picture& picture, int y, float padding_alpha, float* rgba);

/// The same of `picture.unorm8`, padded with the codes of that.
void display_row(const Picture& picture, int y, std::uint8_t padding_alpha, std::uint8_t* rgba);

/// How RGBA becomes code values.
struct CodeRules {
  int max_code = 255;   ///< 255 or 65535
  bool alpha = false;   ///< four codes a pixel: straight alpha, colour divided by it in linear light where it is above
                        ///< 0; else three
  bool dither = false;  ///< colour between two codes becomes one of them by blue noise; else the nearest
};

/// Codes of one row, sRGB-encoded. `x`, `y`: position of the first pixel, for
/// the noise.
void encode_row(const CodeRules& rules, const float* rgba, int width, int x, int y, std::uint8_t* codes);
void encode_row(const CodeRules& rules, const float* rgba, int width, int x, int y, std::uint16_t* codes);

}  // namespace afterglow
