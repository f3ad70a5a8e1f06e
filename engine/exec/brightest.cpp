// SPDX-License-Identifier: MIT
#include "exec/brightest.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "core/half.h"
#include "core/processor.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define AFTERGLOW_AVX2 1
#include <immintrin.h>
#endif

namespace afterglow {

namespace {

constexpr std::uint32_t kLargestFinite = 0x7f7fffff;

constexpr std::uint32_t kOne = 0x3f800000;

using Lanes = std::array<std::uint32_t, 4>;

/// Largest and smallest bits of each channel of RGBA.
struct Range {
  Lanes largest{};
  Lanes smallest{~0u, ~0u, ~0u, ~0u};
};

void add_pixels(const float* from, std::size_t pixels, Range& range) {
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 4; ++c) {
      const auto bits = std::bit_cast<std::uint32_t>(from[4 * i + c]);
      range.largest[c] = std::max(range.largest[c], bits);
      range.smallest[c] = std::min(range.smallest[c], bits);
    }
}

#if AFTERGLOW_AVX2

/// The same, two pixels at a time, four in flight.
__attribute__((target("avx2"))) void add_pixels_avx2(const float* from, std::size_t pixels, Range& range) {
  __m256i most_a = _mm256_setzero_si256(), most_b = most_a;
  __m256i least_a = _mm256_set1_epi32(-1), least_b = least_a;
  for (std::size_t i = 0; i < pixels; i += 4) {
    const __m256i a = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + 4 * i));
    const __m256i b = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + 4 * i + 8));
    most_a = _mm256_max_epu32(most_a, a);
    most_b = _mm256_max_epu32(most_b, b);
    least_a = _mm256_min_epu32(least_a, a);
    least_b = _mm256_min_epu32(least_b, b);
  }
  most_a = _mm256_max_epu32(most_a, most_b);
  least_a = _mm256_min_epu32(least_a, least_b);
  Lanes most, least;
  _mm_storeu_si128(reinterpret_cast<__m128i*>(most.data()),
                   _mm_max_epu32(_mm256_castsi256_si128(most_a), _mm256_extracti128_si256(most_a, 1)));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(least.data()),
                   _mm_min_epu32(_mm256_castsi256_si128(least_a), _mm256_extracti128_si256(least_a, 1)));
  for (std::size_t c = 0; c < 4; ++c) {
    range.largest[c] = std::max(range.largest[c], most[c]);
    range.smallest[c] = std::min(range.smallest[c], least[c]);
  }
}

#endif

Range range_of(const float* from, std::size_t pixels) {
  Range range;
  std::size_t done = 0;
#if AFTERGLOW_AVX2
  if (has_avx2()) {
    done = pixels / 4 * 4;
    add_pixels_avx2(from, done, range);
  }
#endif
  add_pixels(from + 4 * done, pixels - done, range);
  return range;
}

}  // namespace

void Brightest::add_row(const float* row, int channels, int width) {
  std::uint32_t row_bits = 0;
  if (channels == 4) {
    const Range range = range_of(row, static_cast<std::size_t>(width));
    row_bits = std::max({range.largest[0], range.largest[1], range.largest[2]});
    if (range.largest[3] != kOne || range.smallest[3] != kOne) opaque_.store(false, std::memory_order_relaxed);
  } else {
    for (std::ptrdiff_t x = 0; x < width; ++x) {
      for (int c = 0; c < std::min(channels, 3); ++c)
        row_bits = std::max(row_bits, std::bit_cast<std::uint32_t>(row[x * channels + c]));
      if (channels > 4 && row[x * channels + 3] != 1) opaque_.store(false, std::memory_order_relaxed);
    }
  }
  std::uint32_t known = bits_.load(std::memory_order_relaxed);
  while (known < row_bits && !bits_.compare_exchange_weak(known, row_bits, std::memory_order_relaxed)) {
  }
}

float Brightest::value(Storage storage) const {
  const std::uint32_t bits = bits_.load();
  if (bits > kLargestFinite) return std::numeric_limits<float>::quiet_NaN();
  const auto value = std::bit_cast<float>(bits);
  // Rounding keeps the order: the largest stays the largest.
  return storage == Storage::fp16 ? float_from_half(half_from_float(value)) : value;
}

}  // namespace afterglow
