// SPDX-License-Identifier: MIT
#include "window/plain_view.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/processor.h"
#include "image/encode.h"
#include "image/srgb.h"

namespace afterglow {

namespace {

/// The pixel of the image under the middle of one of the target, in floats as view.frag finds it.
int nearest_pixel(int at, float origin, float scale, int picture, int size) {
  const float point = (static_cast<float>(at) + 0.5f - origin) / scale;
  const float pixel = std::floor(point * (static_cast<float>(size) / static_cast<float>(picture)));
  return static_cast<int>(std::clamp(pixel, 0.0f, static_cast<float>(size - 1)));
}

#if defined(__x86_64__)
__attribute__((target("avx2"), always_inline)) inline __m256 next_avx2(__m256 curve, __m256 root, float next) {
  return _mm256_add_ps(_mm256_mul_ps(curve, root), _mm256_set1_ps(next));
}

/// The curve of view.frag.
__attribute__((target("avx2"), always_inline)) inline __m256 srgb_avx2(__m256 c) {
  const __m256 root = _mm256_sqrt_ps(_mm256_sqrt_ps(c));
  __m256 curve = next_avx2(_mm256_set1_ps(-0.0681473692f), root, 0.2895332135f);
  curve = next_avx2(curve, root, -0.5774829909f);
  curve = next_avx2(curve, root, 1.2554045638f);
  curve = next_avx2(curve, root, 0.1620262245f);
  curve = next_avx2(curve, root, -0.0613402120f);
  const __m256 line = _mm256_mul_ps(c, _mm256_set1_ps(12.92f));
  return _mm256_blendv_ps(curve, line, _mm256_cmp_ps(c, _mm256_set1_ps(0.0031308f), _CMP_LE_OQ));
}

/// Two pixels.
__attribute__((target("avx2"), always_inline)) inline __m256i codes_avx2(const float* rgba, __m256 gain) {
  const __m256 zero = _mm256_setzero_ps(), one = _mm256_set1_ps(1);
  const __m256 positive = _mm256_max_ps(_mm256_loadu_ps(rgba), zero);  // its second operand for NaN
  const __m256 held = _mm256_min_ps(_mm256_mul_ps(_mm256_min_ps(positive, _mm256_set1_ps(1e30f)), gain), one);
  return _mm256_cvtps_epi32(_mm256_mul_ps(srgb_avx2(held), _mm256_set1_ps(255)));
}

/// Floats, of a row and the next: other threads have written them, and pages are too short for processors to see it
/// coming.
constexpr int kAhead = 512;

/// Four pixels at a time; how many it did.
__attribute__((target("avx2"))) int encode_avx2(const float* rgba, int count, const PlainView& view,
                                                std::uint32_t* codes) {
  const __m256 gain = _mm256_set1_ps(view.gain);
  const __m128i opaque = _mm_set1_epi32(static_cast<int>(0xff000000u));
  const __m128i order = view.blue_first ? _mm_setr_epi8(2, 1, 0, 3, 6, 5, 4, 7, 10, 9, 8, 11, 14, 13, 12, 15)
                                        : _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const float* from = rgba + static_cast<std::ptrdiff_t>(i) * 4;
    _mm_prefetch(reinterpret_cast<const char*>(from + kAhead), _MM_HINT_T0);
    const __m256i words = _mm256_packs_epi32(codes_avx2(from, gain), codes_avx2(from + 8, gain));
    const __m256i bytes = _mm256_packus_epi16(words, words);  // pixels 0 and 2, then 1 and 3
    const __m128i pixels = _mm_unpacklo_epi32(_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(codes + i), _mm_shuffle_epi8(_mm_or_si128(pixels, opaque), order));
  }
  return i;
}
#endif

std::uint32_t encode_pixel(const float* rgba, const PlainView& view) {
  const CodeEncoder& encoder = CodeEncoder::srgb(255);
  std::array<std::uint8_t, 4> bytes{0, 0, 0, 255};
  for (std::size_t c = 0; c < 3; ++c)
    bytes[view.blue_first ? 2 - c : c] = static_cast<std::uint8_t>(encoder(std::min(rgba[c], 1e30f) * view.gain));
  std::uint32_t out = 0;
  std::memcpy(&out, bytes.data(), sizeof out);
  return out;
}

/// The same codes wherever in a row a pixel lies.
void encode_pixels(const float* rgba, int count, const PlainView& view, std::uint32_t* codes) {
#if defined(__x86_64__)
  if (has_avx2()) {
    const int done = encode_avx2(rgba, count, view, codes);
    if (done == count) return;
    std::array<float, 16> rest{};
    std::array<std::uint32_t, 4> last{};
    std::copy(rgba + static_cast<std::ptrdiff_t>(done) * 4, rgba + static_cast<std::ptrdiff_t>(count) * 4,
              rest.begin());
    encode_avx2(rest.data(), 4, view, last.data());
    std::copy_n(last.begin(), count - done, codes + done);
    return;
  }
#endif
  for (int i = 0; i < count; ++i) codes[i] = encode_pixel(rgba + static_cast<std::ptrdiff_t>(i) * 4, view);
}

}  // namespace

void write_plain_view(const PlainView& view, const Rect& pixels, std::byte* codes) {
  if (pixels.size().area() == 0) return;
  const auto width = static_cast<std::size_t>(pixels.width);
  std::vector<int> columns(width);
  for (int x = 0; x < pixels.width; ++x)
    columns[static_cast<std::size_t>(x)] =
        nearest_pixel(pixels.x + x, view.origin[0], view.scale, view.picture.width, view.size.width);
  const int first = columns.front(), count = columns.back() - first + 1;
  for (int& column : columns) column -= first;
  std::vector<std::uint32_t> line(static_cast<std::size_t>(count)), out(width);
  std::vector<float> floats(view.half ? static_cast<std::size_t>(count) * 4 : 0);
  const std::size_t pixel_bytes = view.half ? 8 : 16;
  int before = -1;  // row of the image
  for (int y = 0; y < pixels.height; ++y, codes += width * sizeof(std::uint32_t)) {
    const int row = nearest_pixel(pixels.y + y, view.origin[1], view.scale, view.picture.height, view.size.height);
    if (row != before) {
      const std::byte* from =
          view.pixels + static_cast<std::size_t>(row) * view.row_pitch + static_cast<std::size_t>(first) * pixel_bytes;
      if (view.half) from_half(reinterpret_cast<const std::uint16_t*>(from), floats.data(), floats.size());
      encode_pixels(view.half ? floats.data() : reinterpret_cast<const float*>(from), count, view, line.data());
      for (std::size_t x = 0; x < width; ++x) out[x] = line[static_cast<std::size_t>(columns[x])];
      before = row;
    }
    std::memcpy(codes, out.data(), width * sizeof(std::uint32_t));
  }
}

}  // namespace afterglow
