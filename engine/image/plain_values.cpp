// SPDX-License-Identifier: MIT
#include "image/plain_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "core/processor.h"
#include "image/picture.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define AFTERGLOW_AVX2 1
#include <immintrin.h>
#endif

namespace afterglow {
namespace {

/// Bits of floats. Those of positive ones are ordered as the numbers are; a negative one has the top bit.
constexpr std::uint32_t kSmallestBits = std::bit_cast<std::uint32_t>(kSmallestColor);
constexpr std::uint32_t kLargestBits = std::bit_cast<std::uint32_t>(kLargestColor);

bool plain(const float* values, std::size_t count) {
  std::uint32_t largest = 0, smallest = ~0u;
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(values[i]);
    largest = std::max(largest, bits);
    smallest = std::min(smallest, bits - 1);  // zero becomes the largest of all
  }
  return largest <= kLargestBits && smallest >= kSmallestBits - 1;
}

#if AFTERGLOW_AVX2

/// The same of 8 values at a time; `count` is a multiple of 16.
__attribute__((target("avx2"))) bool plain_avx2(const float* values, std::size_t count) {
  const __m256i one = _mm256_set1_epi32(1);
  __m256i largest_a = _mm256_setzero_si256(), largest_b = largest_a;
  __m256i smallest_a = _mm256_set1_epi32(-1), smallest_b = smallest_a;
  for (std::size_t i = 0; i < count; i += 16) {
    const __m256i a = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values + i));
    const __m256i b = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values + i + 8));
    largest_a = _mm256_max_epu32(largest_a, a);
    largest_b = _mm256_max_epu32(largest_b, b);
    smallest_a = _mm256_min_epu32(smallest_a, _mm256_sub_epi32(a, one));
    smallest_b = _mm256_min_epu32(smallest_b, _mm256_sub_epi32(b, one));
  }
  alignas(32) std::array<std::uint32_t, 8> largest, smallest;
  _mm256_store_si256(reinterpret_cast<__m256i*>(largest.data()), _mm256_max_epu32(largest_a, largest_b));
  _mm256_store_si256(reinterpret_cast<__m256i*>(smallest.data()), _mm256_min_epu32(smallest_a, smallest_b));
  return std::ranges::max(largest) <= kLargestBits && std::ranges::min(smallest) >= kSmallestBits - 1;
}

#endif

}  // namespace

bool all_plain(const float* values, std::size_t count) {
  std::size_t done = 0;
#if AFTERGLOW_AVX2
  if (has_avx2()) {
    done = count / 16 * 16;
    if (!plain_avx2(values, done)) return false;
  }
#endif
  return plain(values + done, count - done);
}

}  // namespace afterglow
