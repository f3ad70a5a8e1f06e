#include "exec/brightest.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "core/half.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define AFTERGLOW_AVX2 1
#include <immintrin.h>
#endif

namespace afterglow {

namespace {

constexpr std::uint32_t kLargestFinite = 0x7f7fffff;

using Lanes = std::array<std::uint32_t, 4>;

/// Largest bits of each channel of RGBA.
void add_pixels(const float* from, std::size_t pixels, Lanes& largest) {
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 4; ++c)
      largest[c] = std::max(largest[c], std::bit_cast<std::uint32_t>(from[4 * i + c]));
}

#if AFTERGLOW_AVX2

bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2");
  return has;
}

/// The same, two pixels at a time, four in flight.
__attribute__((target("avx2"))) void add_pixels_avx2(const float* from, std::size_t pixels, Lanes& largest) {
  __m256i a = _mm256_setzero_si256(), b = a;
  for (std::size_t i = 0; i < pixels; i += 4) {
    a = _mm256_max_epu32(a, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + 4 * i)));
    b = _mm256_max_epu32(b, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + 4 * i + 8)));
  }
  a = _mm256_max_epu32(a, b);
  const __m128i both = _mm_max_epu32(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
  Lanes found;
  _mm_storeu_si128(reinterpret_cast<__m128i*>(found.data()), both);
  for (std::size_t c = 0; c < 4; ++c) largest[c] = std::max(largest[c], found[c]);
}

#endif

Lanes largest_lanes(const float* from, std::size_t pixels) {
  Lanes largest{};
  std::size_t done = 0;
#if AFTERGLOW_AVX2
  if (has_avx2()) {
    done = pixels / 4 * 4;
    add_pixels_avx2(from, done, largest);
  }
#endif
  add_pixels(from + 4 * done, pixels - done, largest);
  return largest;
}

std::uint32_t largest_bits(const float* row, int channels, int width) {
  if (channels == 4) {
    const auto lanes = largest_lanes(row, static_cast<std::size_t>(width));
    return std::max({lanes[0], lanes[1], lanes[2]});
  }
  std::uint32_t largest = 0;
  for (std::ptrdiff_t x = 0; x < width; ++x)
    for (int c = 0; c < std::min(channels, 3); ++c)
      largest = std::max(largest, std::bit_cast<std::uint32_t>(row[x * channels + c]));
  return largest;
}

}  // namespace

void Brightest::add_row(const float* row, int channels, int width) {
  const std::uint32_t row_bits = largest_bits(row, channels, width);
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
