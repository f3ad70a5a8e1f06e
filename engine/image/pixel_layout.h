// SPDX-License-Identifier: MIT
// How the samples of a video's frame lie in memory, by FFmpeg's names of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/result.h"

namespace afterglow {

struct PixelLayout {
  enum class Kind { yuv, planar_rgb, rgb, bgr };  ///< the last two: all samples of a pixel beside each other
  const char* name;                               ///< "yuv420p10le"
  Kind kind;
  int bits;      ///< of a sample; above 8 in two bytes, little-endian
  int channels;  ///< samples that are stored: 4 with alpha, or with a byte that means nothing (bgr0)
  bool alpha;
  int chroma_x = 0, chroma_y = 0;  ///< of yuv: halvings of the sides

  bool rgb_colors() const { return kind != Kind::yuv; }
  bool packed() const { return kind == Kind::rgb || kind == Kind::bgr; }
  int planes() const { return packed() ? 1 : channels; }
  int sample_bytes() const { return bits > 8 ? 2 : 1; }
};

std::span<const PixelLayout> pixel_layouts();
/// "yuv420p10" is taken for "yuv420p10le". Null: not known.
const PixelLayout* find_pixel_layout(const std::string& name);

/// A frame, ready for an encoder or a stream: planes one behind the other, rows without padding.
struct PackedFrame {
  struct Plane {
    std::size_t offset = 0, stride = 0;
    int rows = 0;
  };
  const PixelLayout* layout = nullptr;
  Size size;
  std::vector<std::uint8_t> bytes;
  std::vector<Plane> planes;
};

/// With planes of the right sizes. Sides of chroma are rounded up. `memory` is used where there is some; the bytes may
/// be anything.
PackedFrame empty_frame(const PixelLayout& layout, Size size, std::vector<std::uint8_t> memory = {});

}  // namespace afterglow
