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

#include "core/half.h"
#include "core/processor.h"
#include "image/encode.h"
#include "image/picture.h"
#include "image/srgb.h"

namespace afterglow {

namespace {

/// Along one axis: from pixels of the target to places of the image, in floats as view.frag has it.
struct Axis {
  float origin, scale, per_point;
  int size;  ///< of the image

  float place(int at) const { return (static_cast<float>(at) + 0.5f - origin) / scale * per_point; }
  int nearest(int at) const {
    return static_cast<int>(std::clamp(std::floor(place(at)), 0.0f, static_cast<float>(size - 1)));
  }
};

/// The pixels of the image that lie under one of the target, along one axis, and how much of each.
struct Covered {
  int begin = 0, end = 0;
  float low = 0, high = 0;
  float share(int pixel) const {
    return std::min(static_cast<float>(pixel + 1), high) - std::max(static_cast<float>(pixel), low);
  }
};

Covered covered(const Axis& axis, int at) {
  const float place = axis.place(at), reach = std::max(axis.per_point / axis.scale, 1.0f);
  Covered out;
  out.low = std::max(place - 0.5f * reach, 0.0f);
  out.high = std::min(place + 0.5f * reach, static_cast<float>(axis.size));
  const int last = axis.size - 1;
  out.begin = std::clamp(static_cast<int>(std::floor(out.low)), 0, last);
  out.end = std::clamp(static_cast<int>(std::ceil(out.high)) - 1, out.begin, last) + 1;
  return out;
}

float tamed(float v) { return std::isnan(v) ? 0 : std::clamp(v, -kLargestColor, kLargestColor); }

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
  const __m256 held = _mm256_min_ps(_mm256_mul_ps(_mm256_min_ps(positive, _mm256_set1_ps(kLargestColor)), gain), one);
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

/// Eight floats at a time; how many it did.
__attribute__((target("avx2"))) std::size_t add_share_avx2(const float* from, float share, std::size_t count,
                                                           float* to) {
  const __m256 largest = _mm256_set1_ps(kLargestColor), least = _mm256_set1_ps(-kLargestColor),
               part = _mm256_set1_ps(share);
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    const __m256 v = _mm256_loadu_ps(from + i);
    const __m256 number = _mm256_and_ps(v, _mm256_cmp_ps(v, v, _CMP_ORD_Q));
    const __m256 held = _mm256_max_ps(_mm256_min_ps(number, largest), least);
    _mm256_storeu_ps(to + i, _mm256_add_ps(_mm256_loadu_ps(to + i), _mm256_mul_ps(held, part)));
  }
  return i;
}
#endif

void add_share(const float* from, float share, std::size_t count, float* to) {
  std::size_t i = 0;
#if defined(__x86_64__)
  if (has_avx2()) i = add_share_avx2(from, share, count, to);
#endif
  for (; i < count; ++i) to[i] += tamed(from[i]) * share;
}

std::uint32_t encode_pixel(const float* rgba, const PlainView& view) {
  const CodeEncoder& encoder = CodeEncoder::srgb(255);
  std::array<std::uint8_t, 4> bytes{0, 0, 0, 255};
  for (std::size_t c = 0; c < 3; ++c)
    bytes[view.blue_first ? 2 - c : c] = static_cast<std::uint8_t>(encoder(tamed(rgba[c]) * view.gain));
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

/// Rows of the image, from one column to another, as floats.
class ImageRows {
 public:
  ImageRows(const PlainView& view, int first, int count)
      : view_(view),
        first_(static_cast<std::size_t>(first)),
        floats_(view.half ? static_cast<std::size_t>(count) * 4 : 0) {}
  /// Holds until the next one.
  const float* row(int y) {
    const std::byte* from =
        view_.pixels + static_cast<std::size_t>(y) * view_.row_pitch + first_ * (view_.half ? 8 : 16);
    if (!view_.half) return reinterpret_cast<const float*>(from);
    floats_from_halves(from, floats_.size(), floats_.data());
    return floats_.data();
  }

 private:
  const PlainView& view_;
  std::size_t first_;
  std::vector<float> floats_;
};

void write_nearest(const PlainView& view, const Axis& across, const Axis& down, const Rect& pixels, std::byte* codes) {
  const auto width = static_cast<std::size_t>(pixels.width);
  std::vector<int> columns(width);
  for (int x = 0; x < pixels.width; ++x) columns[static_cast<std::size_t>(x)] = across.nearest(pixels.x + x);
  const int first = columns.front(), count = columns.back() - first + 1;
  ImageRows rows(view, first, count);
  std::vector<std::uint32_t> line(static_cast<std::size_t>(count)), out(width);
  int before = -1;  // row of the image
  for (int y = 0; y < pixels.height; ++y, codes += width * sizeof(std::uint32_t)) {
    if (const int row = down.nearest(pixels.y + y); row != before) {
      encode_pixels(rows.row(row), count, view, line.data());
      for (std::size_t x = 0; x < width; ++x) out[x] = line[static_cast<std::size_t>(columns[x] - first)];
      before = row;
    }
    std::memcpy(codes, out.data(), width * sizeof(std::uint32_t));
  }
}

void write_means(const PlainView& view, const Axis& across, const Axis& down, const Rect& pixels, std::byte* codes) {
  const auto width = static_cast<std::size_t>(pixels.width);
  std::vector<Covered> columns(width);
  for (int x = 0; x < pixels.width; ++x) columns[static_cast<std::size_t>(x)] = covered(across, pixels.x + x);
  const int first = columns.front().begin, count = columns.back().end - first;
  ImageRows rows(view, first, count);
  std::vector<float> sums(static_cast<std::size_t>(count) * 4), means(width * 4);
  std::vector<std::uint32_t> out(width);
  for (int y = 0; y < pixels.height; ++y, codes += width * sizeof(std::uint32_t)) {
    const Covered row = covered(down, pixels.y + y);
    std::fill(sums.begin(), sums.end(), 0.0f);
    float height = 0;
    for (int i = row.begin; i < row.end; ++i) {
      add_share(rows.row(i), row.share(i), sums.size(), sums.data());
      height += row.share(i);
    }
    for (std::size_t x = 0; x < width; ++x) {
      std::array<float, 4> sum{};
      float total = 0;
      for (int i = columns[x].begin; i < columns[x].end; ++i) {
        const float share = columns[x].share(i);
        const float* from = &sums[static_cast<std::size_t>(i - first) * 4];
        for (std::size_t c = 0; c < 4; ++c) sum[c] += share * from[c];
        total += share;
      }
      const float part = 1 / std::max(total * height, 1e-20f);
      for (std::size_t c = 0; c < 4; ++c) means[x * 4 + c] = sum[c] * part;
    }
    encode_pixels(means.data(), pixels.width, view, out.data());
    std::memcpy(codes, out.data(), width * sizeof(std::uint32_t));
  }
}

}  // namespace

void write_plain_view(const PlainView& view, const Rect& pixels, std::byte* codes) {
  if (pixels.size().area() == 0) return;
  const auto axis = [&](float origin, int size, int picture) {
    return Axis{origin, view.scale, static_cast<float>(size) / static_cast<float>(picture), size};
  };
  const Axis across = axis(view.origin[0], view.size.width, view.picture.width);
  const Axis down = axis(view.origin[1], view.size.height, view.picture.height);
  (view.means ? write_means : write_nearest)(view, across, down, pixels, codes);
}

}  // namespace afterglow
