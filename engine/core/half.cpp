// SPDX-License-Identifier: MIT
#include "core/half.h"

#include <bit>
#include <cstring>

#include "core/processor.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define AFTERGLOW_F16C 1
#include <immintrin.h>
#endif

namespace afterglow {

namespace {

constexpr std::uint16_t kSign = 0x8000;

#if AFTERGLOW_F16C

__attribute__((target("avx,f16c"))) std::uint64_t halves_from_floats_f16c(const float* from, std::size_t count,
                                                                          std::uint16_t* to) {
  const __m256 limit = _mm256_set1_ps(kMaxHalf), negative_limit = _mm256_set1_ps(-kMaxHalf);
  const __m256 sign = _mm256_set1_ps(-0.0f);
  std::uint64_t held = 0;
  for (std::size_t i = 0; i < count; i += 8) {
    __m256 v = _mm256_loadu_ps(from + i);
    const __m256 over = _mm256_cmp_ps(_mm256_andnot_ps(sign, v), limit, _CMP_GT_OQ);
    held += static_cast<unsigned>(__builtin_popcount(static_cast<unsigned>(_mm256_movemask_ps(over))));
    // With the variable second, min and max hand a NaN on.
    v = _mm256_max_ps(negative_limit, _mm256_min_ps(limit, v));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to + i), _mm256_cvtps_ph(v, _MM_FROUND_TO_NEAREST_INT));
  }
  return held;
}

__attribute__((target("avx,f16c"))) std::uint64_t floats_from_halves_f16c(const std::byte* from, std::size_t count,
                                                                          float* to) {
  const __m128i magnitude = _mm_set1_epi16(0x7fff), limit = _mm_set1_epi16(kMaxHalfBits);
  std::uint64_t held = 0;
  for (std::size_t i = 0; i < count; i += 8) {
    const __m128i halves = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + 2 * i));
    _mm256_storeu_ps(to + i, _mm256_cvtph_ps(halves));
    const int bytes = _mm_movemask_epi8(_mm_cmpeq_epi16(_mm_and_si128(halves, magnitude), limit));
    if (bytes != 0) held += static_cast<unsigned>(__builtin_popcount(static_cast<unsigned>(bytes))) / 2;
  }
  return held;
}

#endif

}  // namespace

std::uint16_t half_from_float(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>((bits >> 16) & kSign);
  const std::uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) return sign | 0x7e00;  // NaN
  if (magnitude > std::bit_cast<std::uint32_t>(kMaxHalf)) return sign | kMaxHalfBits;
  if (magnitude < 0x38800000u) {
    // Below 2^-14 the result is subnormal. Adding ½ puts the last bit of a half at the last bit of the float's
    // mantissa, and the addition rounds to nearest even.
    const float shifted = std::bit_cast<float>(magnitude) + 0.5f;
    return sign | static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(shifted) - 0x3f000000u);
  }
  const std::uint32_t odd = (magnitude >> 13) & 1;
  return sign | static_cast<std::uint16_t>((magnitude - 0x38000000u + 0xfff + odd) >> 13);
}

float float_from_half(std::uint16_t bits) {
  const auto sign = static_cast<std::uint32_t>(bits & kSign) << 16;
  const std::uint32_t exponent = (bits >> 10) & 0x1f, mantissa = bits & 0x3ff;
  if (exponent == 0x1f) return std::bit_cast<float>(sign | 0x7f800000u | mantissa << 13);
  if (exponent == 0) {
    const float magnitude = static_cast<float>(mantissa) * 0x1p-24f;
    return sign ? -magnitude : magnitude;
  }
  return std::bit_cast<float>(sign | (exponent + 112) << 23 | mantissa << 13);
}

std::uint64_t halves_from_floats(const float* from, std::size_t count, std::uint16_t* to) {
  std::uint64_t held = 0;
  std::size_t i = 0;
#if AFTERGLOW_F16C
  if (has_f16c()) {
    i = count / 8 * 8;
    held = halves_from_floats_f16c(from, i, to);
  }
#endif
  for (; i < count; ++i) {
    if (from[i] > kMaxHalf || from[i] < -kMaxHalf) ++held;
    to[i] = half_from_float(from[i]);
  }
  return held;
}

std::uint64_t floats_from_halves(const void* halves, std::size_t count, float* to) {
  const auto* from = static_cast<const std::byte*>(halves);
  std::uint64_t held = 0;
  std::size_t i = 0;
#if AFTERGLOW_F16C
  if (has_f16c()) {
    i = count / 8 * 8;
    held = floats_from_halves_f16c(from, i, to);
  }
#endif
  for (; i < count; ++i) {
    std::uint16_t bits = 0;
    std::memcpy(&bits, from + 2 * i, sizeof bits);
    held += (bits & ~kSign) == kMaxHalfBits;
    to[i] = float_from_half(bits);
  }
  return held;
}

}  // namespace afterglow
