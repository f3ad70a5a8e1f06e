// SPDX-License-Identifier: MIT
// Pictures of the caller as rows of floats, and rows of results as the caller's samples.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "api/afterglow.h"
#include "core/geometry.h"
#include "core/result.h"
#include "exec/frame.h"

namespace afterglow::api {

/// An afterglow_image that was checked, with its strides.
struct Pixels {
  std::byte* data = nullptr;
  Size size;
  int channels = 0;
  afterglow_samples samples = AFTERGLOW_FLOAT;
  std::ptrdiff_t row_stride = 0, pixel_stride = 0;

  std::byte* at(int x, int y) const { return data + y * row_stride + x * pixel_stride; }
  std::size_t sample_bytes() const { return samples == AFTERGLOW_FLOAT ? 4 : samples == AFTERGLOW_HALF ? 2 : 1; }
  bool packed() const {
    return pixel_stride == static_cast<std::ptrdiff_t>(sample_bytes() * static_cast<std::size_t>(channels));
  }
};

enum class ImageRole { color, depth, normal, motion };

/// Errors (usage): no picture is so small or so large.
Result<void> check_size(Size size);

/// Errors (usage): no data, sizes, channels or samples that the role does not allow, strides shorter than a pixel or a
/// row, or beyond all memory.
Result<Pixels> check_image(const afterglow_image& given, ImageRole role, const char* name);

/// Samples that had to be made finite, or were negative colours. Thread-safe.
using Mended = std::atomic<std::uint64_t>;

/// Of each image of a frame.
class MendedImages {
 public:
  Mended& operator[](ImageRole role) { return counts_[static_cast<std::size_t>(role)]; }
  std::uint64_t operator[](ImageRole role) const { return counts_[static_cast<std::size_t>(role)]; }
  std::uint64_t sum() const {
    std::uint64_t all = 0;
    for (const Mended& count : counts_) all += count;
    return all;
  }
  void clear() {
    for (Mended& count : counts_) count = 0;
  }

 private:
  std::array<Mended, 4> counts_{};
};

/// The picture as an input of a frame: RGBA, scene-linear, alpha associated, finite and, without `keep_negative`, ≥ 0.
/// `mended` and what `pixels` points at must outlive it.
HostImage color_image(const Pixels& pixels, bool keep_negative, Mended& mended);
/// The same of another image, which is no colour.
HostImage auxiliary_image(const Pixels& pixels, ImageRole role, Mended& mended);

/// Writes results into `to`, in `region` alone. `source`: where alpha comes from when the result's storage is too
/// coarse for it.
struct ResultRules {
  Pixels to, source;
  Rect region;
  bool dither = false;  ///< of 8-bit results that the device has not encoded
};
HostResult result_rows(const ResultRules& rules);

}  // namespace afterglow::api
