// SPDX-License-Identifier: MIT
#include "image/encode.h"

#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/alpha.h"
#include "core/half.h"
#include "core/processor.h"
#include "image/srgb.h"

namespace afterglow {
namespace {

constexpr float kLargestHalf = 65504.0f;

float held(float value) { return value > kLargestHalf ? kLargestHalf : value < -kLargestHalf ? -kLargestHalf : value; }

#if defined(__x86_64__)
/// Eight at a time, where the processor can. Leaves the rest to the caller.
__attribute__((target("avx,f16c"))) std::size_t to_half_f16c(const float* values, std::uint16_t* halves,
                                                             std::size_t count, std::uint64_t& overflows) {
  const __m256 largest = _mm256_set1_ps(kLargestHalf), smallest = _mm256_set1_ps(-kLargestHalf);
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    const __m256 v = _mm256_loadu_ps(values + i);
    const __m256 outside = _mm256_or_ps(_mm256_cmp_ps(v, largest, _CMP_GT_OQ), _mm256_cmp_ps(v, smallest, _CMP_LT_OQ));
    if (const int mask = _mm256_movemask_ps(outside))
      overflows += static_cast<unsigned>(__builtin_popcount(static_cast<unsigned>(mask)));
    // min and max give their second operand for NaN: NaN stays NaN.
    const __m256 inside = _mm256_max_ps(smallest, _mm256_min_ps(largest, v));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(halves + i), _mm256_cvtps_ph(inside, _MM_FROUND_TO_NEAREST_INT));
  }
  return i;
}
#endif

/// The code below or above a value by the pixel's threshold, so that an area of them has the light that was meant.
/// Between two codes the sRGB curve bends a little: a share of t pixels at the upper one makes t(1 + rt)/(1 + r) of the
/// step. What lies within a thousandth of a code is that code everywhere. shaders/lib/dither.glsl does the same.
std::uint32_t dithered(float linear, float threshold, int max_code) {
  const double clamped = linear > 0 ? std::min(static_cast<double>(linear), 1.0) : 0.0;
  const double encoded = std::min(linear_to_srgb(clamped), 1.0) * max_code, code = std::floor(encoded);
  const double from = code / max_code, r = from > 0.03925 ? 0.7 / (max_code * (from + 0.055)) : 0;
  const double t = (encoded - code) * (1 + r * (encoded - code)) / (1 + r);
  return static_cast<std::uint32_t>(std::min(code + (t * 1.002 - 0.001 > threshold ? 1 : 0), double(max_code)));
}

/// The nearest code of a linear quantity; exact, since the product of a float and 65535 fits a double.
std::uint32_t linear_code(float value, int max_code) {
  if (!(value > 0)) return 0;
  return static_cast<std::uint32_t>(std::min(static_cast<double>(value), 1.0) * max_code + 0.5);
}

/// A stored value by its code: the nearest, or, with a threshold, one of the two beside it. What lies within a
/// thousandth of a code is that code everywhere, as in `dithered`.
std::uint32_t stored_code(float stored, int max_code) {
  return static_cast<std::uint32_t>(std::min(stored * static_cast<float>(max_code) + 0.5f, float(max_code)));
}
std::uint32_t stored_code(float stored, float threshold, int max_code) {
  const float encoded = std::min(stored, 1.0f) * static_cast<float>(max_code), code = std::floor(encoded);
  return static_cast<std::uint32_t>(
      std::min(code + ((encoded - code) * 1.002f - 0.001f > threshold ? 1 : 0), float(max_code)));
}

template <class Code>
void encode_in_space(const CodeRules& rules, const float* rgba, int width, int x0, int y, Code* codes) {
  std::vector<float> row(rgba, rgba + static_cast<std::size_t>(width) * 4);
  if (rules.alpha) make_straight(row.data(), static_cast<std::size_t>(width));
  rules.space->encode(row.data(), static_cast<std::size_t>(width), row.data());
  for (int x = 0; x < width; ++x) {
    const float* pixel = &row[static_cast<std::size_t>(x) * 4];
    for (int c = 0; c < 3; ++c)
      *codes++ = static_cast<Code>(rules.dither ? stored_code(pixel[c], blue_noise(x0 + x, y), rules.max_code)
                                                : stored_code(pixel[c], rules.max_code));
    if (rules.alpha) *codes++ = static_cast<Code>(linear_code(pixel[3], rules.max_code));
  }
}

template <class Code>
void encode(const CodeRules& rules, const float* rgba, int width, int x0, int y, Code* codes) {
  if (rules.space) return encode_in_space(rules, rgba, width, x0, y, codes);
  const CodeEncoder& encoder = CodeEncoder::srgb(rules.max_code);
  for (int x = 0; x < width; ++x, rgba += 4) {
    const float alpha = std::min(rgba[3], 1.0f), cover = rules.alpha ? cover_of(alpha) : 1;
    for (int c = 0; c < 3; ++c) {
      const float linear = cover != 1 ? rgba[c] / cover : rgba[c];
      *codes++ =
          static_cast<Code>(rules.dither ? dithered(linear, blue_noise(x0 + x, y), rules.max_code) : encoder(linear));
    }
    if (rules.alpha) *codes++ = static_cast<Code>(linear_code(alpha, rules.max_code));
  }
}

/// Row `y` of the display window from `pixels`, which cover the data window. `take(from, count, to)` makes samples of
/// them.
template <class Stored, class Sample, class Take>
void padded_row(const Picture& picture, const Stored* pixels, int y, Sample padding_alpha, const Take& take,
                Sample* rgba) {
  const Rect &data = picture.data_window, &display = picture.display_window;
  const auto fill = [&](int begin, int end) {
    for (int x = begin; x < end; ++x) {
      rgba[x * 4] = rgba[x * 4 + 1] = rgba[x * 4 + 2] = 0;
      rgba[x * 4 + 3] = padding_alpha;
    }
  };
  const int row = display.y + y - data.y;
  const int begin = std::clamp(data.x - display.x, 0, display.width);
  const int end = std::clamp(data.x + data.width - display.x, begin, display.width);
  if (row < 0 || row >= data.height || begin == end) return fill(0, display.width);
  fill(0, begin);
  const std::size_t first =
      (static_cast<std::size_t>(row) * static_cast<std::size_t>(data.width) + (display.x + begin - data.x)) * 4;
  take(pixels + first, static_cast<std::size_t>(end - begin) * 4, rgba + begin * 4);
  fill(end, display.width);
}

}  // namespace

void make_straight(float* rgba, std::size_t pixels) {
  for (float* p = rgba; p != rgba + 4 * pixels; p += 4)
    if (const float cover = cover_of(std::min(p[3], 1.0f)); cover != 1)
      for (int c = 0; c < 3; ++c) p[c] /= cover;
}

std::uint64_t to_half(const float* values, std::uint16_t* halves, std::size_t count) {
  std::uint64_t overflows = 0;
  std::size_t i = 0;
#if defined(__x86_64__)
  if (has_f16c()) i = to_half_f16c(values, halves, count, overflows);
#endif
  for (; i < count; ++i) {
    overflows += std::abs(values[i]) > kLargestHalf;
    halves[i] = Imath::half(held(values[i])).bits();
  }
  return overflows;
}

const float* color_row(const Picture& picture, int y, std::vector<float>& memory) {
  if (picture.halves.empty()) return picture.color.at(0, y);
  memory.resize(static_cast<std::size_t>(picture.color.width) * 4);
  floats_from_halves(half_row(picture, y), memory.size(), memory.data());
  return memory.data();
}

void display_row(const Picture& picture, int y, float padding_alpha, float* rgba) {
  const auto copy = [](const float* from, std::size_t count, float* to) { std::copy_n(from, count, to); };
  const auto open = [](const std::uint16_t* from, std::size_t count, float* to) {
    floats_from_halves(from, count, to);
  };
  if (picture.halves.empty()) {
    padded_row(picture, picture.color.pixels.data(), y, padding_alpha, copy, rgba);
  } else {
    padded_row(picture, picture.halves.data(), y, padding_alpha, open, rgba);
  }
}
void display_row(const Picture& picture, int y, std::uint8_t padding_alpha, std::uint8_t* rgba) {
  const auto copy = [](const std::uint8_t* from, std::size_t count, std::uint8_t* to) { std::copy_n(from, count, to); };
  padded_row(picture, picture.unorm8.data(), y, padding_alpha, copy, rgba);
}

void encode_row(const CodeRules& rules, const float* rgba, int width, int x, int y, std::uint8_t* codes) {
  encode(rules, rgba, width, x, y, codes);
}
void encode_row(const CodeRules& rules, const float* rgba, int width, int x, int y, std::uint16_t* codes) {
  encode(rules, rgba, width, x, y, codes);
}

}  // namespace afterglow
