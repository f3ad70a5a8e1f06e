// SPDX-License-Identifier: MIT
#include "image/pack_frame.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "core/parallel.h"
#include "core/processor.h"
#include "image/encode.h"

#define AFTERGLOW_INLINE __attribute__((always_inline)) inline

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

/// Rows of a picture as stored values of RGB and straight alpha, which is there only where the layout has one.
class StoredRows {
 public:
  StoredRows(const Picture& picture, const PackRules& rules) : picture_(picture), rules_(rules) {}

  void row(int y, std::vector<float>& rgba) const {
    const auto width = static_cast<std::size_t>(picture_.display_window.width);
    rgba.resize(width * 4);
    const bool beyond = rules_.beyond && !rules_.layout->rgb_colors();
    if (!beyond && !rules_.layout->alpha &&
        picture_.data_window == picture_.display_window) {  // as it lies, without a copy
      if (picture_.halves.empty()) return rules_.space->encode(picture_.color.at(0, y), width, rgba.data());
      return rules_.space->encode_colors(half_row(picture_, y), width, rgba.data());
    }
    display_row(picture_, y, picture_.has_alpha ? 0.0f : 1.0f, rgba.data());
    if (rules_.layout->alpha) make_straight(rgba.data(), width);
    if (!beyond) return rules_.space->encode(rgba.data(), width, rgba.data());
    const std::vector<float> light = rgba;
    rules_.space->encode_beyond(light.data(), width, rgba.data());
  }
  /// What lies within a thousandth of a code is that code everywhere, as in encode.cpp.
  float noise(std::size_t x, int y) const {
    return rules_.dither ? 1 - (blue_noise(static_cast<int>(x), y) + 0.001f) / 1.002f : 0.5f;
  }

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

/// A row of yuv, in values of 0…1 and −½…½.
struct YuvRow {
  explicit YuvRow(std::size_t width) : luma(width), blue(width), red(width) {}
  std::vector<float> luma, blue, red;
};

AFTERGLOW_INLINE void to_yuv(const float* rgba, LumaWeights weights, std::size_t width, float* __restrict luma,
                             float* __restrict blue, float* __restrict red) {
  for (std::size_t x = 0; x < width; ++x) {
    const double r = rgba[x * 4], g = rgba[x * 4 + 1], b = rgba[x * 4 + 2];
    const double l = weights.red * r + (1 - weights.red - weights.blue) * g + weights.blue * b;
    luma[x] = static_cast<float>(l);
    blue[x] = static_cast<float>((b - l) / (2 * (1 - weights.blue)));
    red[x] = static_cast<float>((r - l) / (2 * (1 - weights.red)));
  }
}

/// With half of a row filtered away, if that is wished.
AFTERGLOW_INLINE void filter_across(const float* full, std::size_t full_width, bool half, float* __restrict out,
                                    std::size_t width) {
  if (!half) return static_cast<void>(std::copy_n(full, width, out));
  const std::size_t last = full_width - 1;
  const auto at = [&](std::size_t i) {
    return 0.25f * full[i > 0 ? 2 * i - 1 : 0] + 0.5f * full[2 * i] + 0.25f * full[std::min(2 * i + 1, last)];
  };
  out[0] = at(0);
  for (std::size_t i = 1; i + 1 < width; ++i)
    out[i] = 0.25f * full[2 * i - 1] + 0.5f * full[2 * i] + 0.25f * full[2 * i + 1];
  out[width - 1] = at(width - 1);
}

/// `base` + `range` · value as codes of 8 bits, times `scale` where there are more.
template <class Code>
AFTERGLOW_INLINE void to_codes(const float* values, const float* noise, std::size_t width, float base, float range,
                               float scale, float most, Code* __restrict codes) {
  for (std::size_t x = 0; x < width; ++x) {
    const float code = (base + range * values[x]) * scale + noise[x];
    codes[x] = static_cast<Code>(static_cast<int>(std::min(std::max(code, 0.0f), most)));
  }
}

/// What of this is compiled twice.
struct YuvLoops {
  AFTERGLOW_INLINE static void convert(const float* rgba, LumaWeights weights, bool half, YuvRow& full, float* blue,
                                       float* red, std::size_t chroma_width) {
    const std::size_t width = full.luma.size();
    to_yuv(rgba, weights, width, full.luma.data(), full.blue.data(), full.red.data());
    filter_across(full.blue.data(), width, half, blue, chroma_width);
    filter_across(full.red.data(), width, half, red, chroma_width);
  }
  AFTERGLOW_INLINE static void filter_down(const std::array<const float*, 4>& rows, std::size_t width,
                                           float* __restrict out) {
    for (std::size_t x = 0; x < width; ++x)
      out[x] = 0.125f * (rows[0][x] + rows[3][x]) + 0.375f * (rows[1][x] + rows[2][x]);
  }
  AFTERGLOW_INLINE static void put(const float* values, const float* noise, std::size_t width, float base, float range,
                                   int bits, std::uint8_t* row) {
    const float scale = static_cast<float>(1 << (bits - 8)), most = static_cast<float>((1 << bits) - 1);
    if (bits > 8) {
      to_codes(values, noise, width, base, range, scale, most, reinterpret_cast<std::uint16_t*>(row));
    } else {
      to_codes(values, noise, width, base, range, scale, most, row);
    }
  }
};

#if defined(__x86_64__)
struct YuvLoopsAvx2 {
  __attribute__((target("avx2"))) static void convert(const float* rgba, LumaWeights weights, bool half, YuvRow& full,
                                                      float* blue, float* red, std::size_t chroma_width) {
    YuvLoops::convert(rgba, weights, half, full, blue, red, chroma_width);
  }
  __attribute__((target("avx2"))) static void filter_down(const std::array<const float*, 4>& rows, std::size_t width,
                                                          float* out) {
    YuvLoops::filter_down(rows, width, out);
  }
  __attribute__((target("avx2"))) static void put(const float* values, const float* noise, std::size_t width,
                                                  float base, float range, int bits, std::uint8_t* row) {
    YuvLoops::put(values, noise, width, base, range, bits, row);
  }
};
#endif

/// Rows of yuv planes from rows of a picture, top down; the last four rows of chroma are kept.
template <class Loops>
class YuvBand {
 public:
  YuvBand(const StoredRows& rows, LumaWeights luma, PackedFrame& frame)
      : rows_(rows),
        weights_(luma),
        frame_(frame),
        layout_(*frame.layout),
        width_(static_cast<std::size_t>(frame.size.width)),
        chroma_width_((width_ + static_cast<std::size_t>(layout_.chroma_x)) >> layout_.chroma_x),
        full_(width_),
        noise_(width_) {
    for (auto* kept : {&blue_, &red_})
      for (auto& row : *kept) row.resize(chroma_width_);
  }

  /// These rows of chroma, and those of luma that belong to them.
  void make(int begin, int end) {
    const int last = frame_.size.height - 1, down = layout_.chroma_y, first_luma = begin << down;
    const int luma_end = std::min(end << down, last + 1);
    int next = std::max(first_luma - down, 0);
    std::vector<float> filtered(chroma_width_);
    for (int y = begin; y < end; ++y) {
      for (const int need = std::min((y << down) + 2 * down, last); next <= need; ++next)
        take_row(next, next >= first_luma && next < luma_end);
      for (std::size_t plane = 1; plane <= 2; ++plane) {
        const auto& kept = plane == 1 ? blue_ : red_;
        const auto at = [&](int row) { return kept[static_cast<std::size_t>(std::clamp(row, 0, last)) % 4].data(); };
        const float* values = at(y);
        if (down > 0) {
          Loops::filter_down({at(2 * y - 1), at(2 * y), at(2 * y + 1), at(2 * y + 2)}, chroma_width_, filtered.data());
          values = filtered.data();
        }
        // Other places of the noise than luma's, so that the three do not go together.
        put(plane, y, values, chroma_width_, 128, 224, plane == 1 ? 21 : 43, plane == 1 ? 13 : 37);
      }
    }
  }

 private:
  void take_row(int y, bool own) {
    rows_.row(y, rgba_);
    const std::size_t place = static_cast<std::size_t>(y) % 4;
    Loops::convert(rgba_.data(), weights_, layout_.chroma_x > 0, full_, blue_[place].data(), red_[place].data(),
                   chroma_width_);
    if (!own) return;
    put(0, y, full_.luma.data(), width_, 16, 219, 0, 0);
    if (!layout_.alpha) return;
    const PlaneOut alpha(frame_, 3);
    for (std::size_t x = 0; x < width_; ++x)
      alpha.put(x, y, std::clamp(rgba_[x * 4 + 3], 0.0f, 1.0f) * alpha.max(), 0.5f);
  }

  void put(std::size_t plane, int y, const float* values, std::size_t width, float base, float range, int noise_x,
           int noise_y) {
    for (std::size_t x = 0; x < width; ++x) noise_[x] = rows_.noise(x + static_cast<std::size_t>(noise_x), y + noise_y);
    const auto& out = frame_.planes[plane];
    Loops::put(values, noise_.data(), width, base, range, layout_.bits,
               frame_.bytes.data() + out.offset + out.stride * static_cast<std::size_t>(y));
  }

  const StoredRows& rows_;
  LumaWeights weights_;
  PackedFrame& frame_;
  const PixelLayout& layout_;
  std::size_t width_, chroma_width_;
  YuvRow full_;
  std::vector<float> noise_, rgba_;
  std::array<std::vector<float>, 4> blue_, red_;
};

template <class Loops>
void pack_yuv(const StoredRows& rows, LumaWeights luma, PackedFrame& frame) {
  parallel_rows(frame.planes[1].rows, static_cast<long long>(frame.size.area()) * 4,
                [&](int begin, int end) { YuvBand<Loops>(rows, luma, frame).make(begin, end); });
}

}  // namespace

PackedFrame pack_frame(const Picture& picture, const PackRules& rules, std::vector<std::uint8_t> memory) {
  PackedFrame frame = empty_frame(*rules.layout, picture.display_window.size(), std::move(memory));
  const StoredRows rows(picture, rules);
  if (rules.layout->rgb_colors()) {
    pack_rgb(rows, frame);
  } else {
#if defined(__x86_64__)
    if (has_avx2()) {
      pack_yuv<YuvLoopsAvx2>(rows, rules.luma, frame);
      return frame;
    }
#endif
    pack_yuv<YuvLoops>(rows, rules.luma, frame);
  }
  return frame;
}

}  // namespace afterglow
