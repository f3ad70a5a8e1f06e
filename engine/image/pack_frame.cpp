// SPDX-License-Identifier: MIT
#include "image/pack_frame.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/parallel.h"
#include "image/encode.h"

namespace afterglow {
namespace {

/// Where samples of a plane go, as codes of 8 or 16 bits.
class PlaneOut {
 public:
  PlaneOut(PackedFrame& frame, std::size_t plane)
      : base_(frame.bytes.data() + frame.planes[plane].offset),
        stride_(frame.planes[plane].stride),
        wide_(frame.layout->bits > 8),
        max_((1 << frame.layout->bits) - 1) {}

  /// `value` in codes; `noise` in [0, 1): ½ rounds.
  void put(std::size_t at, int y, float value, float noise) const {
    const auto code = static_cast<int>(std::clamp(value + noise, 0.0f, static_cast<float>(max_)));
    std::uint8_t* row = base_ + stride_ * static_cast<std::size_t>(y);
    if (wide_) {
      const auto narrow = static_cast<std::uint16_t>(code);
      std::memcpy(row + at * 2, &narrow, 2);
    } else {
      row[at] = static_cast<std::uint8_t>(code);
    }
  }
  float max() const { return static_cast<float>(max_); }

 private:
  std::uint8_t* base_;
  std::size_t stride_;
  bool wide_;
  int max_;
};

/// Rows of a picture as stored values of RGB and straight alpha.
class StoredRows {
 public:
  StoredRows(const Picture& picture, const PackRules& rules) : picture_(picture), rules_(rules) {}

  void row(int y, std::vector<float>& rgba) const {
    const auto width = static_cast<std::size_t>(picture_.display_window.width);
    rgba.resize(width * 4);
    display_row(picture_, y, picture_.has_alpha ? 0.0f : 1.0f, rgba.data());
    if (rules_.layout->alpha)
      for (std::size_t i = 0; i < rgba.size(); i += 4)
        if (const float alpha = rgba[i + 3]; alpha > 0 && alpha != 1)
          for (std::size_t c = 0; c < 3; ++c) rgba[i + c] /= alpha;
    rules_.space->encode(rgba.data(), width);
  }
  float noise(std::size_t x, int y) const { return rules_.dither ? 1 - blue_noise(static_cast<int>(x), y) : 0.5f; }

 private:
  const Picture& picture_;
  const PackRules& rules_;
};

template <class Work>
void for_rows(Size size, const Work& work) {
  parallel_rows(size.height, static_cast<long long>(size.area()) * 4, [&](int begin, int end) {
    std::vector<float> rgba;
    for (int y = begin; y < end; ++y) work(y, rgba);
  });
}

void pack_rgb(const StoredRows& rows, PackedFrame& frame) {
  const PixelLayout& layout = *frame.layout;
  const auto channels = static_cast<std::size_t>(layout.channels);
  const bool reversed = layout.kind == PixelLayout::Kind::bgr;
  const auto width = static_cast<std::size_t>(frame.size.width);
  std::vector<PlaneOut> planes;
  for (std::size_t i = 0; i < frame.planes.size(); ++i) planes.emplace_back(frame, i);
  // Planes of RGB come as green, blue, red, alpha.
  constexpr std::array<std::size_t, 4> kPlane{2, 0, 1, 3};
  for_rows(frame.size, [&](int y, std::vector<float>& rgba) {
    rows.row(y, rgba);
    for (std::size_t x = 0; x < width; ++x) {
      const float noise = rows.noise(x, y);
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t place = reversed && c < 3 ? 2 - c : c;
        const bool colour = c < 3;
        const float value = colour ? rgba[x * 4 + c] : layout.alpha ? std::clamp(rgba[x * 4 + 3], 0.0f, 1.0f) : 0.0f;
        const PlaneOut& out = layout.packed() ? planes[0] : planes[kPlane[c]];
        out.put(layout.packed() ? x * channels + place : x, y, value * out.max(), colour ? noise : 0.5f);
      }
    }
  });
}

/// From −½…½, with `half` of them across filtered away.
struct ChromaRows {
  std::size_t width = 0;
  std::vector<float> blue, red;
};

void filter_across(const std::vector<float>& full, bool half, float* out, std::size_t width) {
  if (!half) return static_cast<void>(std::copy(full.begin(), full.end(), out));
  const std::size_t last = full.size() - 1;
  for (std::size_t i = 0; i < width; ++i) {
    const std::size_t at = 2 * i;
    out[i] = 0.25f * full[at > 0 ? at - 1 : 0] + 0.5f * full[at] + 0.25f * full[std::min(at + 1, last)];
  }
}

/// Luma and alpha are done; chroma is left at the height of the picture.
ChromaRows pack_luma(const StoredRows& rows, LumaWeights luma, PackedFrame& frame) {
  const PixelLayout& layout = *frame.layout;
  const auto width = static_cast<std::size_t>(frame.size.width);
  ChromaRows chroma;
  chroma.width = (width + static_cast<std::size_t>(layout.chroma_x)) >> layout.chroma_x;
  chroma.blue.resize(chroma.width * static_cast<std::size_t>(frame.size.height));
  chroma.red.resize(chroma.blue.size());
  const PlaneOut luma_out(frame, 0), alpha_out(frame, layout.alpha ? 3 : 0);
  const float scale = static_cast<float>(1 << (layout.bits - 8));
  for_rows(frame.size, [&](int y, std::vector<float>& rgba) {
    std::vector<float> blue(width), red(width);
    rows.row(y, rgba);
    for (std::size_t x = 0; x < width; ++x) {
      const double r = rgba[x * 4], g = rgba[x * 4 + 1], b = rgba[x * 4 + 2];
      const double l = luma.red * r + (1 - luma.red - luma.blue) * g + luma.blue * b;
      blue[x] = static_cast<float>((b - l) / (2 * (1 - luma.blue)));
      red[x] = static_cast<float>((r - l) / (2 * (1 - luma.red)));
      luma_out.put(x, y, (16 + 219 * static_cast<float>(l)) * scale, rows.noise(x, y));
      if (layout.alpha) alpha_out.put(x, y, std::clamp(rgba[x * 4 + 3], 0.0f, 1.0f) * alpha_out.max(), 0.5f);
    }
    const std::size_t at = chroma.width * static_cast<std::size_t>(y);
    filter_across(blue, layout.chroma_x > 0, &chroma.blue[at], chroma.width);
    filter_across(red, layout.chroma_x > 0, &chroma.red[at], chroma.width);
  });
  return chroma;
}

void pack_chroma(const StoredRows& rows, const ChromaRows& chroma, PackedFrame& frame) {
  const PixelLayout& layout = *frame.layout;
  const float scale = static_cast<float>(1 << (layout.bits - 8));
  const int last = frame.size.height - 1;
  const PlaneOut blue_out(frame, 1), red_out(frame, 2);
  const auto sample = [&](const std::vector<float>& from, std::size_t x, int y) {
    const auto at = [&](int row) {
      return from[chroma.width * static_cast<std::size_t>(std::clamp(row, 0, last)) + x];
    };
    if (layout.chroma_y == 0) return at(y);
    return 0.125f * (at(2 * y - 1) + at(2 * y + 2)) + 0.375f * (at(2 * y) + at(2 * y + 1));
  };
  for_rows({static_cast<int>(chroma.width), frame.planes[1].rows}, [&](int y, std::vector<float>&) {
    for (std::size_t x = 0; x < chroma.width; ++x) {
      // Other places of the noise than luma's, so that the three do not go together.
      blue_out.put(x, y, (128 + 224 * sample(chroma.blue, x, y)) * scale, rows.noise(x + 21, y + 13));
      red_out.put(x, y, (128 + 224 * sample(chroma.red, x, y)) * scale, rows.noise(x + 43, y + 37));
    }
  });
}

}  // namespace

PackedFrame pack_frame(const Picture& picture, const PackRules& rules) {
  PackedFrame frame = empty_frame(*rules.layout, picture.display_window.size());
  const StoredRows rows(picture, rules);
  if (rules.layout->rgb_colors()) {
    pack_rgb(rows, frame);
  } else {
    const ChromaRows chroma = pack_luma(rows, rules.luma, frame);
    pack_chroma(rows, chroma, frame);
  }
  return frame;
}

}  // namespace afterglow
