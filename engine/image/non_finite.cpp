// SPDX-License-Identifier: MIT
#include "image/non_finite.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <vector>

#include "core/parallel.h"
#include "core/text.h"

namespace afterglow {
namespace {

constexpr std::uint32_t kExponent = 0x7f800000;

bool is_finite(float value) { return (std::bit_cast<std::uint32_t>(value) & kExponent) != kExponent; }

/// In blocks of a fixed size without branches, so that it vectorises. One more in the exponent reaches the sign's bit
/// where the exponent is that of infinities and NaN.
bool any_non_finite(const float* values, std::size_t count) {
  constexpr std::size_t kBlock = 8;
  std::array<std::uint32_t, kBlock> bits{};
  std::size_t i = 0;
  for (; i + kBlock <= count; i += kBlock)
    for (std::size_t k = 0; k < kBlock; ++k)
      bits[k] |= (std::bit_cast<std::uint32_t>(values[i + k]) & 0x7fffffff) + 0x00800000;
  return std::ranges::any_of(bits, [](std::uint32_t b) { return b >> 31 != 0; }) ||
         !std::all_of(values + i, values + count, is_finite);
}

bool before(const NonFinitePixel& a, const NonFinitePixel& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

/// Of one sample; `image` is as it was before any was replaced.
float mean_of_neighbours(const Image& image, int x, int y, int channel) {
  for (int n = 1; n <= kNeighbourReach; ++n) {
    double sum = 0;
    int count = 0;
    for (int v = std::max(y - n, 0); v <= std::min(y + n, image.height - 1); ++v)
      for (int u = std::max(x - n, 0); u <= std::min(x + n, image.width - 1); ++u)
        if (const float value = image.at(u, v)[channel]; is_finite(value)) sum += value, ++count;
    if (count > 0) return static_cast<float>(sum / count);
  }
  return 0;
}

}  // namespace

std::string NonFinitePixel::text() const {
  std::vector<std::string> shown;
  for (int c = 0; c < channels; ++c) {
    const float value = values[static_cast<std::size_t>(c)];
    shown.push_back(std::isnan(value) ? "nan" : fmt::format("{:.6g}", value));  // its sign means nothing
  }
  return fmt::format("pixel {},{}: ({})", x, y, join(shown));
}

std::string NonFinite::text() const {
  std::vector<std::string> parts;
  if (nan) parts.push_back(fmt::format("{} NaN", nan));
  if (plus_infinity) parts.push_back(fmt::format("{} +Inf", plus_infinity));
  if (minus_infinity) parts.push_back(fmt::format("{} -Inf", minus_infinity));
  return join(parts);
}

NonFinite& operator+=(NonFinite& a, const NonFinite& b) {
  a.nan += b.nan;
  a.plus_infinity += b.plus_infinity;
  a.minus_infinity += b.minus_infinity;
  if (b.first && (!a.first || before(*b.first, *a.first))) a.first = b.first;
  return a;
}

void note_non_finite(const float* row, int channels, int width, int y, NonFinite& found) {
  const auto n = static_cast<std::size_t>(channels);
  if (!any_non_finite(row, n * static_cast<std::size_t>(width))) return;
  NonFinite own;
  for (int x = 0; x < width; ++x) {
    const float* pixel = row + static_cast<std::size_t>(x) * n;
    if (!any_non_finite(pixel, n)) continue;
    for (std::size_t c = 0; c < n; ++c) {
      own.nan += std::isnan(pixel[c]);
      own.plus_infinity += std::isinf(pixel[c]) && pixel[c] > 0;
      own.minus_infinity += std::isinf(pixel[c]) && pixel[c] < 0;
    }
    if (own.first) continue;
    own.first = NonFinitePixel{.x = x, .y = y, .channels = std::min(channels, 4), .values = {}};
    std::copy_n(pixel, own.first->channels, own.first->values.begin());
  }
  found += own;
}

NonFinite find_non_finite(const Image& image) {
  NonFinite found;
  std::mutex mutex;
  parallel_rows(image.height, static_cast<long long>(image.pixels.size()), [&](int begin, int end) {
    NonFinite own;
    for (int y = begin; y < end; ++y) note_non_finite(image.at(0, y), image.channels, image.width, y, own);
    const std::lock_guard lock(mutex);
    found += own;
  });
  return found;
}

void repair_from_neighbours(Image& image) {
  struct Mended {
    std::size_t at;
    float value;
  };
  std::vector<Mended> mended;
  std::mutex mutex;
  parallel_rows(image.height, static_cast<long long>(image.pixels.size()), [&](int begin, int end) {
    std::vector<Mended> own;
    for (int y = begin; y < end; ++y) {
      const float* row = image.at(0, y);
      const int samples = image.width * image.channels;
      if (!any_non_finite(row, static_cast<std::size_t>(samples))) continue;
      for (int i = 0; i < samples; ++i)
        if (!is_finite(row[i]))
          own.push_back({static_cast<std::size_t>(row + i - image.pixels.data()),
                         mean_of_neighbours(image, i / image.channels, y, i % image.channels)});
    }
    const std::lock_guard lock(mutex);
    mended.insert(mended.end(), own.begin(), own.end());
  });
  for (const auto& one : mended) image.pixels[one.at] = one.value;
}

}  // namespace afterglow
