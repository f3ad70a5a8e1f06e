// SPDX-License-Identifier: MIT
#include "image/png_filter.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "core/processor.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#define AFTERGLOW_INLINE __attribute__((always_inline)) inline

namespace afterglow {
namespace {

/// Whichever of the three is nearest to left + above - corner; ties go to the left, then to the one above. In bytes
/// alone, so that it vectorises well: where both differences have one sign, the corner is never the nearest.
AFTERGLOW_INLINE std::uint8_t paeth(std::uint8_t left, std::uint8_t above, std::uint8_t corner) {
  const std::uint8_t a = std::max(above, corner) - std::min(above, corner);
  const std::uint8_t b = std::max(left, corner) - std::min(left, corner);
  const std::uint8_t apart = std::max(a, b) - std::min(a, b);
  const std::uint8_t c = (above >= corner) == (left >= corner) ? std::uint8_t{255} : apart;
  const std::uint8_t vertical = b <= c ? above : corner;
  return a <= std::min(b, c) ? left : vertical;
}

/// Bytes taken as signed: the smaller, the likelier to compress well.
AFTERGLOW_INLINE std::uint32_t weight(const std::uint8_t* bytes, std::size_t size) {
  std::uint32_t sum = 0;
  std::size_t i = 0;
#if defined(__SSE2__)
  const __m128i middle = _mm_set1_epi8(-128);  // how far a byte is from 0 is how far it is from there, shifted so
  __m128i sums = _mm_setzero_si128();
  for (; i + 16 <= size; i += 16) {
    const __m128i shifted = _mm_xor_si128(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes + i)), middle);
    sums = _mm_add_epi64(sums, _mm_sad_epu8(shifted, middle));
  }
  sum = static_cast<std::uint32_t>(_mm_cvtsi128_si32(sums) + _mm_cvtsi128_si32(_mm_srli_si128(sums, 8)));
#endif
  for (; i < size; ++i) sum += static_cast<std::uint32_t>(std::abs(static_cast<std::int8_t>(bytes[i])));
  return sum;
}

AFTERGLOW_INLINE void filter_row(const std::uint8_t* __restrict row, const std::uint8_t* __restrict above,
                                 std::size_t size, std::size_t pixel, std::uint8_t* __restrict scratch,
                                 std::uint8_t* __restrict out) {
  std::uint8_t *sub = scratch, *up = scratch + size, *average = scratch + 2 * size, *best_of_both = scratch + 3 * size;
  const std::size_t head = std::min(pixel, size);
  std::copy_n(row, head, sub);
  for (std::size_t i = head; i < size; ++i) sub[i] = static_cast<std::uint8_t>(row[i] - row[i - pixel]);
  const std::uint8_t* best = sub;
  std::uint8_t filter = 1;
  if (above) {
    for (std::size_t i = 0; i < size; ++i) up[i] = static_cast<std::uint8_t>(row[i] - above[i]);
    for (std::size_t i = 0; i < head; ++i) {
      average[i] = static_cast<std::uint8_t>(row[i] - above[i] / 2);
      best_of_both[i] = up[i];  // Paeth of nothing, above, nothing
    }
    for (std::size_t i = head; i < size; ++i)
      average[i] = static_cast<std::uint8_t>(row[i] - (row[i - pixel] + above[i]) / 2);
    for (std::size_t i = head; i < size; ++i)
      best_of_both[i] = static_cast<std::uint8_t>(row[i] - paeth(row[i - pixel], above[i], above[i - pixel]));
    std::uint32_t smallest = weight(sub, size);
    const std::uint8_t* candidates[] = {up, average, best_of_both};
    for (std::uint8_t f = 0; f < 3; ++f) {
      const std::uint32_t w = weight(candidates[f], size);
      if (w >= smallest) continue;
      smallest = w;
      best = candidates[f];
      filter = static_cast<std::uint8_t>(f + 2);
    }
  }
  out[0] = filter;
  std::memcpy(out + 1, best, size);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void filter_row_avx2(const std::uint8_t* row, const std::uint8_t* above,
                                                     std::size_t size, std::size_t pixel, std::uint8_t* scratch,
                                                     std::uint8_t* out) {
  filter_row(row, above, size, pixel, scratch, out);
}
#endif

}  // namespace

void png_filter_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t pixel,
                    std::uint8_t* scratch, std::uint8_t* out) {
#if defined(__x86_64__)
  if (has_avx2()) return filter_row_avx2(row, above, size, pixel, scratch, out);
#endif
  filter_row(row, above, size, pixel, scratch, out);
}

}  // namespace afterglow
