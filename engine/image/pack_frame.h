// SPDX-License-Identifier: MIT
// A finished picture as a frame of a video: encoded in a space, as RGB or YUV, with chroma of its size.
#pragma once

#include <cstdint>
#include <vector>

#include "image/output_space.h"
#include "image/picture.h"
#include "image/pixel_layout.h"

namespace afterglow {

/// Luma's share of red and blue; green has the rest.
struct LumaWeights {
  double red = 0.2126, blue = 0.0722;
};
inline constexpr LumaWeights kBt709Luma{0.2126, 0.0722}, kBt601Luma{0.299, 0.114}, kBt2020Luma{0.2627, 0.0593};

struct PackRules {
  const PixelLayout* layout = nullptr;
  const OutputSpace* space = nullptr;  ///< never null
  LumaWeights luma;                    ///< of yuv
  bool dither = false;                 ///< blue noise between two codes; else the nearest
  bool beyond = false;                 ///< YUV keeps what its codes have room for below black and above white
};

/// The display window. RGB is of full range, YUV of limited range (ITU-R BT.709, 4.6), alpha straight and of full
/// range. Chroma lies at the left of its pixels and half-way between its rows, as MPEG-2 has it: means of 1 2 1 across
/// and 1 3 3 1 down. In double precision but for the curve of the space (see OutputSpace). `memory`: of a frame
/// that is done.
PackedFrame pack_frame(const Picture& picture, const PackRules& rules, std::vector<std::uint8_t> memory = {});

}  // namespace afterglow
