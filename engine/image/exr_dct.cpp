// SPDX-License-Identifier: MIT
#include "image/exr_dct.h"

#include <half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/processor.h"

namespace afterglow {
namespace {

using Cosines = std::array<float, kDctSize>;
using Halves = std::array<std::uint16_t, kDctSize>;

constexpr std::uint16_t kZeros = 0xff00;  // and their number; alone: to the end of the block

// The tables of JPEG (ITU T.81, annex K.1), which DWA takes relative to their least.
constexpr std::array<std::uint8_t, kDctSize> kBrightness{
    16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,  //
    14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,  //
    18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,  //
    49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};
constexpr std::array<std::uint8_t, kDctSize> kColour{17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99,  //
                                                     24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99, 99, 99, 99,  //
                                                     99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99,  //
                                                     99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99};

Cosines tolerances(float level, const std::array<std::uint8_t, kDctSize>& table) {
  const float least = *std::min_element(table.begin(), table.end());
  Cosines result;
  for (std::size_t i = 0; i < kDctSize; ++i) result[i] = std::max(level, 0.0f) / 100000.0f * (table[i] / least);
  return result;
}

/// Places of a block in the order of rising frequency: along the diagonals, to and fro.
constexpr std::array<std::uint8_t, kDctSize> zigzag() {
  std::array<std::uint8_t, kDctSize> places{};
  std::size_t i = 0;
  for (int sum = 0; sum <= 2 * (kDctSide - 1); ++sum)
    for (int step = 0; step <= sum; ++step) {
      const int x = sum % 2 == 0 ? step : sum - step, y = sum - x;
      if (x < kDctSide && y < kDctSide) places[i++] = static_cast<std::uint8_t>(y * kDctSide + x);
    }
  return places;
}
constexpr auto kZigzag = zigzag();

/// Of one direction: rows are frequencies. `turned`: columns are.
Cosines basis(bool turned) {
  Cosines result;
  for (std::size_t k = 0; k < kDctSide; ++k)
    for (std::size_t n = 0; n < kDctSide; ++n) {
      const double scale = k == 0 ? std::sqrt(0.125) : 0.5;
      const double value =
          scale * std::cos((2.0 * static_cast<double>(n) + 1) * static_cast<double>(k) * std::numbers::pi / 16);
      result[turned ? n * kDctSide + k : k * kDctSide + n] = static_cast<float>(value);
    }
  return result;
}
const Cosines kBasis = basis(false), kTurnedBasis = basis(true);

using Row = float __attribute__((vector_size(kDctSide * sizeof(float))));

/// a · b, as matrices.
[[gnu::always_inline]] inline void multiply(const Cosines& a, const Cosines& b, Cosines& out) {
  Row rows[kDctSide];
  std::memcpy(rows, b.data(), sizeof rows);
  for (std::size_t r = 0; r < kDctSide; ++r) {
    Row sum = a[r * kDctSide] * rows[0];
    for (std::size_t k = 1; k < kDctSide; ++k) sum += a[r * kDctSide + k] * rows[k];
    std::memcpy(&out[r * kDctSide], &sum, sizeof sum);
  }
}

/// R, G, B become brightness and two differences, as Rec. 709 weighs them.
[[gnu::always_inline]] inline void part_colour(DctBlock& block) {
  for (std::size_t i = 0; i < kDctSize; ++i) {
    const float r = block[0][i], g = block[1][i], b = block[2][i];
    block[0][i] = 0.2126f * r + 0.7152f * g + 0.0722f * b;
    block[1][i] = -0.1146f * r - 0.3854f * g + 0.5f * b;
    block[2][i] = 0.5f * r - 0.4542f * g - 0.0458f * b;
  }
}

std::uint16_t* put_cosines(const Halves& values, std::uint64_t set, std::uint16_t* ac) {
  int at = 1;
  for (set &= ~std::uint64_t{1}; set != 0; set &= set - 1) {
    const int next = std::countr_zero(set), zeros = next - at;
    if (zeros > 0) *ac++ = static_cast<std::uint16_t>(zeros == 1 ? 0 : kZeros | zeros);
    *ac++ = values[static_cast<std::size_t>(next)];
    at = next + 1;
  }
  if (at < kDctSize) *ac++ = at == kDctSize - 1 ? std::uint16_t{0} : kZeros;
  return ac;
}

std::uint16_t half_of(float value) { return Imath::half(value).bits(); }
float float_of(std::uint16_t bits) {
  Imath::half value;
  value.setBits(bits);
  return value;
}

struct Plain {
  static void few_bits(const Cosines& values, const Cosines& tolerances, Halves& out) {
    for (std::size_t i = 0; i < kDctSize; ++i) out[i] = with_few_bits(values[i], tolerances[i]);
  }
  static std::uint64_t not_zero(const Halves& values) {
    std::uint64_t set = 0;
    for (std::size_t i = 0; i < kDctSize; ++i) set |= std::uint64_t{values[i] != 0} << i;
    return set;
  }
};

template <class Way>
[[gnu::always_inline]] inline std::uint16_t* encode_block(DctBlock& block, const Cosines& brightness,
                                                          const Cosines& colour, std::uint16_t* ac,
                                                          std::array<std::uint16_t, 3>& dc) {
  part_colour(block);
  for (std::size_t c = 0; c < 3; ++c) {
    Cosines half_way;
    multiply(kBasis, block[c], half_way);
    multiply(half_way, kTurnedBasis, block[c]);
    Halves rounded, values;
    Way::few_bits(block[c], c == 0 ? brightness : colour, rounded);
    for (std::size_t i = 0; i < kDctSize; ++i) values[i] = rounded[kZigzag[i]];
    dc[c] = values[0];
    ac = put_cosines(values, Way::not_zero(values), ac);
  }
  return ac;
}

#if defined(__x86_64__)
#define AFTERGLOW_VECTORS __attribute__((target("avx2,f16c")))

struct Vectors {
  /// All bits below the highest that is set, and it.
  AFTERGLOW_VECTORS static __m128i filled(__m128i x) {
    x = _mm_or_si128(x, _mm_srli_epi16(x, 1));
    x = _mm_or_si128(x, _mm_srli_epi16(x, 2));
    x = _mm_or_si128(x, _mm_srli_epi16(x, 4));
    return _mm_or_si128(x, _mm_srli_epi16(x, 8));
  }
  AFTERGLOW_VECTORS static __m128i highest(__m128i full) { return _mm_xor_si128(full, _mm_srli_epi16(full, 1)); }
  /// A mask of floats as one of 16-bit integers.
  AFTERGLOW_VECTORS static __m128i narrow(__m256 mask) {
    const __m256i bits = _mm256_castps_si256(mask);
    return _mm_packs_epi32(_mm256_castsi256_si128(bits), _mm256_extracti128_si256(bits, 1));
  }

  /// with_few_bits(), eight at a time: its comments hold here.
  AFTERGLOW_VECTORS static void few_bits(const Cosines& values, const Cosines& tolerances, Halves& out) {
    const __m256 sign_bit = _mm256_set1_ps(-0.0f);
    const __m128i zero = _mm_setzero_si128();
    for (std::size_t i = 0; i < kDctSize; i += 8) {
      const __m256 value = _mm256_loadu_ps(&values[i]), tolerance = _mm256_loadu_ps(&tolerances[i]);
      const __m256 size = _mm256_andnot_ps(sign_bit, value);
      const __m128i low =
          _mm256_cvtps_ph(_mm256_max_ps(_mm256_sub_ps(size, tolerance), _mm256_setzero_ps()), _MM_FROUND_TO_POS_INF);
      const __m128i high = _mm256_cvtps_ph(_mm256_add_ps(size, tolerance), _MM_FROUND_TO_NEG_INF);
      const __m128i nearest = _mm256_cvtps_ph(size, _MM_FROUND_TO_NEAREST_INT);
      const __m128i free = filled(_mm_xor_si128(low, high)), top = highest(free);
      const __m128i common = _mm_andnot_si128(free, low), rest = _mm_and_si128(low, free);
      const __m128i below = highest(filled(_mm_and_si128(nearest, free))), above = _mm_slli_epi16(below, 1);
      const __m128i a = _mm_or_si128(common, below), b = _mm_or_si128(common, above);
      const __m256 to_a = _mm256_andnot_ps(sign_bit, _mm256_sub_ps(_mm256_cvtph_ps(a), size));
      const __m256 to_b = _mm256_andnot_ps(sign_bit, _mm256_sub_ps(_mm256_cvtph_ps(b), size));
      const __m128i nearer = narrow(_mm256_cmp_ps(to_a, to_b, _CMP_LE_OQ));
      const __m128i take_a =
          _mm_or_si128(_mm_cmpeq_epi16(below, top), _mm_andnot_si128(_mm_cmpgt_epi16(rest, below), nearer));
      __m128i result = _mm_blendv_epi8(b, a, take_a);
      result = _mm_blendv_epi8(result, low, _mm_cmpeq_epi16(rest, zero));
      result = _mm_blendv_epi8(result, nearest, _mm_cmpgt_epi16(low, high));
      const __m128i sign = _mm_andnot_si128(
          _mm_cmpeq_epi16(result, zero),
          _mm_slli_epi16(narrow(_mm256_castsi256_ps(_mm256_srai_epi32(_mm256_castps_si256(value), 31))), 15));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(&out[i]), _mm_or_si128(result, sign));
    }
  }

  AFTERGLOW_VECTORS static std::uint64_t not_zero(const Halves& values) {
    std::uint64_t zeros = 0;
    for (std::size_t i = 0; i < kDctSize; i += 16) {
      const auto* at = reinterpret_cast<const __m128i*>(&values[i]);
      const __m128i equal = _mm_packs_epi16(_mm_cmpeq_epi16(_mm_loadu_si128(at), _mm_setzero_si128()),
                                            _mm_cmpeq_epi16(_mm_loadu_si128(at + 1), _mm_setzero_si128()));
      zeros |= static_cast<std::uint64_t>(static_cast<unsigned>(_mm_movemask_epi8(equal))) << i;
    }
    return ~zeros;
  }
};

AFTERGLOW_VECTORS std::uint16_t* encode_by_vectors(DctBlock& block, const Cosines& brightness, const Cosines& colour,
                                                   std::uint16_t* ac, std::array<std::uint16_t, 3>& dc) {
  return encode_block<Vectors>(block, brightness, colour, ac, dc);
}
#endif

}  // namespace

const float* dwa_curve() {
  static const std::vector<float> curve = [] {
    std::vector<float> values(65536);
    for (unsigned bits = 0; bits < values.size(); ++bits) {
      const double value = float_of(static_cast<std::uint16_t>(bits)), size = std::abs(value);
      const double kept = size <= 1 ? std::pow(size, 1 / 2.2) : std::log(size) / 2.2 + 1;
      values[bits] = std::isfinite(value) ? static_cast<float>(std::copysign(kept, value)) : 0.0f;
    }
    return values;
  }();
  return curve.data();
}

std::uint16_t with_few_bits(float value, float tolerance) {
  const float size = std::abs(value), least = std::max(size - tolerance, 0.0f), most = size + tolerance;
  const std::uint16_t nearest = half_of(size);
  // Half floats above 0 are in the order of their bits: all those between `low` and `high` are allowed.
  std::uint16_t low = half_of(least), high = most < 65504 ? half_of(most) : std::uint16_t{0x7bff};
  if (float_of(low) < least) ++low;
  if (float_of(high) > most) --high;
  std::uint16_t result = nearest;
  if (low <= high) {
    // Above the highest bit in which they differ, all have the same bits. Below it one more is enough, or none when
    // `low` has none there: powers of two, from what `low` has to that highest bit.
    const unsigned width = static_cast<unsigned>(std::bit_width(static_cast<unsigned>(low ^ high)));
    const unsigned free = (1u << width) - 1, common = low & ~free, rest = low & free;
    if (rest == 0) {
      result = low;
    } else {
      const unsigned below = std::bit_floor(nearest & free), above = 2 * below;
      const auto a = static_cast<std::uint16_t>(common | below), b = static_cast<std::uint16_t>(common | above);
      const bool nearer = std::abs(float_of(a) - size) <= std::abs(float_of(b) - size);
      result = below == (free + 1) / 2 || (below >= rest && nearer) ? a : b;
    }
  }
  return result == 0 ? result : static_cast<std::uint16_t>(result | (std::signbit(value) ? 0x8000 : 0));
}

DctEncoder::DctEncoder(float level, bool vectors)
    : brightness_(tolerances(level, kBrightness)),
      colour_(tolerances(level, kColour)),
      vectors_(vectors && has_avx2() && has_f16c()) {}

std::uint16_t* DctEncoder::run(DctBlock& block, std::uint16_t* ac, std::array<std::uint16_t, 3>& dc) const {
#if defined(__x86_64__)
  if (vectors_) return encode_by_vectors(block, brightness_, colour_, ac, dc);
#endif
  return encode_block<Plain>(block, brightness_, colour_, ac, dc);
}

}  // namespace afterglow
