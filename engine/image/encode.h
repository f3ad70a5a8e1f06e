// SPDX-License-Identifier: MIT
// Scene-linear floats to what files store: half floats, and code values for displays.
#pragma once

#include <cstdint>
#include <memory>

#include "core/image_data.h"
#include "image/output_space.h"
#include "image/picture.h"

namespace afterglow {

/// Half floats of `count` floats, round to nearest even; finite values beyond ±65504 and infinities are held there.
/// Returns how many were.
std::uint64_t to_half(const float* values, std::uint16_t* halves, std::size_t count);

/// Row `y` of colours that are half floats, counted from the data window's top.
inline const std::uint16_t* half_row(const Picture& picture, int y) {
  return picture.halves.data() + static_cast<std::size_t>(picture.color.width) * 4 * static_cast<std::size_t>(y);
}

/// Row `y` of the colours, counted from the data window's top: as it lies in the picture, or made of half floats in
/// `memory`.
const float* color_row(const Picture& picture, int y, std::vector<float>& memory);

/// Row `y` of the display window, counted from its top: RGBA pixels of `picture`, and (0, 0, 0, `padding_alpha`) where
/// it has none.
void display_row(const Picture& picture, int y, float padding_alpha, float* rgba);

/// The same of `picture.unorm8`, padded with the codes of that.
void display_row(const Picture& picture, int y, std::uint8_t padding_alpha, std::uint8_t* rgba);

/// RGBA pixels without their coverage (math.md §19); in place. Codes hold an alpha of 1 at most, so that is what an
/// alpha above it counts for.
void make_straight(float* rgba, std::size_t pixels);

/// How RGBA becomes code values.
struct CodeRules {
  int max_code = 255;   ///< 255, 1023, 4095 or 65535
  bool alpha = false;   ///< four codes a pixel: straight alpha, colour divided by it in linear light where it is above
                        ///< 0; else three
  bool dither = false;  ///< colour between two codes becomes one of them by blue noise; else the nearest
  const OutputSpace* space = nullptr;  ///< null: sRGB
};

/// Codes of one row. `x`, `y`: position of the first pixel, for the noise.
void encode_row(const CodeRules& rules, const float* rgba, int width, int x, int y, std::uint8_t* codes);
void encode_row(const CodeRules& rules, const float* rgba, int width, int x, int y, std::uint16_t* codes);

/// The noise of dithering is blue: thresholds that spread evenly, without the grid of ordered noise or the clumps of
/// white noise, in a tile that repeats. Its sides in pixels:
inline constexpr int kBlueNoiseSize = 64;

/// Threshold in (0, 1) of a pixel of the tile, which repeats; x and y ≥ 0. Each of 4096 evenly spaced ones occurs once.
float blue_noise(int x, int y);

/// The tile as an image for shaders, threshold in red. Made once.
std::shared_ptr<const ImageData> blue_noise_image();

}  // namespace afterglow
