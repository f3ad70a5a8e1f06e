// SPDX-License-Identifier: MIT
#include "image/pixel_layout.h"

#include <utility>

namespace afterglow {
namespace {

using enum PixelLayout::Kind;
constexpr std::array kLayouts{
    PixelLayout{"yuv420p", yuv, 8, 3, false, 1, 1},
    PixelLayout{"yuv422p", yuv, 8, 3, false, 1, 0},
    PixelLayout{"yuv444p", yuv, 8, 3, false},
    PixelLayout{"yuv420p10le", yuv, 10, 3, false, 1, 1},
    PixelLayout{"yuv422p10le", yuv, 10, 3, false, 1, 0},
    PixelLayout{"yuv444p10le", yuv, 10, 3, false},
    PixelLayout{"yuv420p12le", yuv, 12, 3, false, 1, 1},
    PixelLayout{"yuv422p12le", yuv, 12, 3, false, 1, 0},
    PixelLayout{"yuv444p12le", yuv, 12, 3, false},
    PixelLayout{"yuv420p16le", yuv, 16, 3, false, 1, 1},
    PixelLayout{"yuv422p16le", yuv, 16, 3, false, 1, 0},
    PixelLayout{"yuv444p16le", yuv, 16, 3, false},
    PixelLayout{"yuva420p", yuv, 8, 4, true, 1, 1},
    PixelLayout{"yuva444p10le", yuv, 10, 4, true},
    PixelLayout{"gbrp10le", planar_rgb, 10, 3, false},
    PixelLayout{"gbrp12le", planar_rgb, 12, 3, false},
    PixelLayout{"gbrp16le", planar_rgb, 16, 3, false},
    PixelLayout{"gbrap10le", planar_rgb, 10, 4, true},
    PixelLayout{"gbrap12le", planar_rgb, 12, 4, true},
    PixelLayout{"gbrap16le", planar_rgb, 16, 4, true},
    PixelLayout{"rgb24", rgb, 8, 3, false},
    PixelLayout{"rgba", rgb, 8, 4, true},
    PixelLayout{"bgr0", bgr, 8, 4, false},
    PixelLayout{"bgra", bgr, 8, 4, true},
    PixelLayout{"rgb48le", rgb, 16, 3, false},
    PixelLayout{"rgba64le", rgb, 16, 4, true},
};

}  // namespace

std::span<const PixelLayout> pixel_layouts() { return kLayouts; }

const PixelLayout* find_pixel_layout(const std::string& name) {
  for (const PixelLayout& layout : kLayouts)
    if (name == layout.name || name + "le" == layout.name) return &layout;
  return nullptr;
}

PackedFrame empty_frame(const PixelLayout& layout, Size size, std::vector<std::uint8_t> memory) {
  PackedFrame frame{&layout, size, std::move(memory), {}};
  std::size_t bytes = 0;
  for (int plane = 0; plane < layout.planes(); ++plane) {
    const bool chroma = layout.kind == PixelLayout::Kind::yuv && (plane == 1 || plane == 2);
    const int sx = chroma ? layout.chroma_x : 0, sy = chroma ? layout.chroma_y : 0;
    const int width = (size.width + (1 << sx) - 1) >> sx, rows = (size.height + (1 << sy) - 1) >> sy;
    const auto stride = static_cast<std::size_t>(width) *
                        static_cast<std::size_t>(layout.sample_bytes() * (layout.packed() ? layout.channels : 1));
    frame.planes.push_back({bytes, stride, rows});
    bytes += stride * static_cast<std::size_t>(rows);
  }
  frame.bytes.resize(bytes);
  return frame;
}

}  // namespace afterglow
