// SPDX-License-Identifier: MIT
#include "image/output_space.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <numeric>
#include <string_view>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/half.h"
#include "core/processor.h"
#include "image/hlg_rendering.h"

namespace afterglow {
namespace {

constexpr int kMantissaBits = 7, kShift = 23 - kMantissaBits;  // parts of an octave
constexpr float kSmallest = 0x1p-40f, kLargest = 0x1p10f;      // the brightest that a space holds is below
constexpr std::uint32_t kMask = (1u << kShift) - 1;
constexpr int kStepsBelow = 4096;  // of light below 0, where codes stand for such
constexpr int kStepsWide = 1 << 14;

std::uint32_t part_of(float light) { return std::bit_cast<std::uint32_t>(light) >> kShift; }

/// The stored value of this light; the curves rise. Above 1 the curve goes on straight, so that lines between two of
/// the table are right up to its end.
double inverse_of(double (*to_linear)(double), double light) {
  constexpr double kStep = 1e-4;
  double low = 0, high = 1;
  if (const double most = to_linear(high); most <= light)
    return std::min(high + (light - most) * kStep / (most - to_linear(high - kStep)), 2.0);
  if (to_linear(low) >= light) return low;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (to_linear(middle) <= light ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

OutputSpace::OutputSpace(const InputSpace& space)
    : name_(space.name),
      of_display_(space.of_display),
      linear_(space.linear()),
      hlg_display_(space.hlg_display),
      primaries_(space.primaries),
      to_linear_(space.to_linear) {
  of_zero_ = static_cast<float>(inverse_of(space.to_linear, 0));
  for (std::uint32_t part = part_of(kSmallest); part <= part_of(kLargest); ++part)
    table_.push_back(
        static_cast<float>(inverse_of(space.to_linear, static_cast<double>(std::bit_cast<float>(part << kShift)))));
  darkest_ = std::min(static_cast<float>(space.to_linear(0)), 0.0f);
  for (int i = 0; darkest_ < 0 && i <= kStepsBelow; ++i)
    below_.push_back(static_cast<float>(
        inverse_of(space.to_linear, static_cast<double>(darkest_) * (kStepsBelow - i) / kStepsBelow)));
  const Matrix3 matrix = inverse(to_rec709(space.primaries));
  if (!nearly_equal(matrix, kIdentity, 1e-6)) matrix_ = matrix;
}

const OutputSpace& OutputSpace::of(const InputSpace& space) {
  static std::mutex mutex;
  static std::array<std::unique_ptr<const OutputSpace>, 32> made;
  const auto index = static_cast<std::size_t>(&space - input_spaces().data());
  const std::lock_guard lock(mutex);
  auto& one = made.at(index);
  if (!one) one.reset(new OutputSpace(space));
  return *one;
}

/// What the curve takes, of linear Rec.709.
void OutputSpace::to_own(float* rgb) const {
  if (matrix_) multiply(*matrix_, rgb, rgb);
  if (hlg_display_) hlg_to_scene(rgb);
}

float OutputSpace::stored_below(float light) const {
  if (below_.empty() || light <= darkest_) return below_.empty() ? of_zero_ : 0.0f;
  const float position = (1 - light / darkest_) * kStepsBelow;
  const auto step = std::min(static_cast<std::size_t>(position), below_.size() - 2);
  return below_[step] + (below_[step + 1] - below_[step]) * (position - static_cast<float>(step));
}

float OutputSpace::stored_value(float light) const {
  if (light < 0) return stored_below(light);
  if (!(light > kSmallest)) return light > 0 ? of_zero_ + (table_.front() - of_zero_) * (light / kSmallest) : of_zero_;
  if (light >= kLargest) return 1;
  const std::size_t part = part_of(light) - part_of(kSmallest);
  const float t = static_cast<float>(std::bit_cast<std::uint32_t>(light) & kMask) * (1.0f / (kMask + 1));
  return std::min(table_[part] + (table_[part + 1] - table_[part]) * t, 1.0f);
}

#if defined(__x86_64__)
/// `stored_value` of two pixels at a time, the same bits; how many pixels that were.
__attribute__((target("avx2"))) std::size_t OutputSpace::encode_pairs(const float* rgba, std::size_t pixels,
                                                                      float* stored) const {
  const __m256i first = _mm256_set1_epi32(static_cast<int>(part_of(kSmallest)));
  const __m256i last = _mm256_set1_epi32(static_cast<int>(table_.size()) - 2);
  const __m256 of_zero = _mm256_set1_ps(of_zero_), rise = _mm256_set1_ps(table_.front() - of_zero_);
  const __m256 one = _mm256_set1_ps(1), smallest = _mm256_set1_ps(kSmallest), largest = _mm256_set1_ps(kLargest);
  const auto at = [table = table_.data()](auto part) { return table + static_cast<std::uint32_t>(part); };
  const auto ends = [&](auto parts) {
    return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(at(parts))));
  };
  const auto two_ends = [&](auto parts) {
    return _mm_loadh_pi(ends(parts), reinterpret_cast<const __m64*>(at(static_cast<std::uint64_t>(parts) >> 32)));
  };
  std::size_t i = 0;
  for (; i + 2 <= pixels; i += 2, rgba += 8, stored += 8) {
    const __m256 light = _mm256_loadu_ps(rgba);
    const __m256i bits = _mm256_castps_si256(light);
    __m256i part = _mm256_sub_epi32(_mm256_srli_epi32(bits, kShift), first);
    part = _mm256_min_epi32(_mm256_max_epi32(part, _mm256_setzero_si256()), last);
    // Both ends of a part lie side by side: one read for the two. Alpha needs none. Single reads, as gathers take twice
    // the time on some processors.
    const __m128i left = _mm256_castsi256_si128(part), right = _mm256_extracti128_si256(part, 1);
    const __m256 a = _mm256_set_m128(two_ends(_mm_cvtsi128_si64(right)), two_ends(_mm_cvtsi128_si64(left)));
    const __m256 b = _mm256_set_m128(ends(_mm_extract_epi64(right, 1)), ends(_mm_extract_epi64(left, 1)));
    const __m256 low = _mm256_shuffle_ps(a, b, _MM_SHUFFLE(2, 0, 2, 0));
    const __m256 high = _mm256_shuffle_ps(a, b, _MM_SHUFFLE(3, 1, 3, 1));
    const __m256 t = _mm256_mul_ps(_mm256_cvtepi32_ps(_mm256_and_si256(bits, _mm256_set1_epi32(kMask))),
                                   _mm256_set1_ps(1.0f / (kMask + 1)));
    __m256 value = _mm256_min_ps(_mm256_add_ps(low, _mm256_mul_ps(_mm256_sub_ps(high, low), t)), one);
    value = _mm256_blendv_ps(value, one, _mm256_cmp_ps(light, largest, _CMP_GE_OQ));
    // NaN and what is below 0 become 0: max gives its second operand for NaN.
    const __m256 dark = _mm256_div_ps(_mm256_max_ps(light, _mm256_setzero_ps()), smallest);
    const __m256 near_zero = _mm256_add_ps(of_zero, _mm256_mul_ps(rise, dark));
    value = _mm256_blendv_ps(near_zero, value, _mm256_cmp_ps(light, smallest, _CMP_GT_OQ));
    _mm256_storeu_ps(stored, _mm256_blend_ps(value, light, 0x88));  // alpha stays
    const int below = _mm256_movemask_ps(_mm256_cmp_ps(light, _mm256_setzero_ps(), _CMP_LT_OQ)) & 0x77;
    if (below == 0 || below_.empty()) continue;
    alignas(32) std::array<float, 8> lights;
    _mm256_store_ps(lights.data(), light);
    for (std::size_t k = 0; k < lights.size(); ++k)
      if ((below >> k & 1) != 0) stored[k] = stored_below(lights[k]);
  }
  return i;
}
#endif

void OutputSpace::encode(const float* rgba, std::size_t pixels, float* stored) const {
#if defined(__x86_64__)
  if (!matrix_ && has_avx2()) {
    const std::size_t done = encode_pairs(rgba, pixels, stored);
    rgba += 4 * done;
    stored += 4 * done;
    pixels -= done;
  }
#endif
  for (std::size_t i = 0; i < pixels; ++i, rgba += 4, stored += 4) {
    std::array<float, 4> pixel{rgba[0], rgba[1], rgba[2], rgba[3]};
    to_own(pixel.data());
    for (std::size_t c = 0; c < 3; ++c) stored[c] = stored_value(pixel[c]);
    stored[3] = pixel[3];
  }
}

const std::vector<double>& OutputSpace::wide() const {
  std::call_once(wide_made_, [&] {
    constexpr double kStep = 1.0 / kStepsWide;
    std::vector<double> below;
    double light = to_linear_(0);
    for (int i = 1; i <= 2 * kStepsWide && to_linear_(-i * kStep) < light; ++i)
      below.push_back(light = to_linear_(-i * kStep));
    wide_.assign(below.rbegin(), below.rend());
    wide_from_ = -static_cast<double>(below.size()) * kStep;
    for (int i = 0; i <= 3 * kStepsWide && (wide_.empty() || to_linear_(i * kStep) > wide_.back()); ++i)
      wide_.push_back(to_linear_(i * kStep));
  });
  return wide_;
}

float OutputSpace::beyond(float light) const {
  const auto& lights = wide();
  const auto above = std::upper_bound(lights.begin(), lights.end(), static_cast<double>(light));
  if (above == lights.begin()) return static_cast<float>(wide_from_);
  const auto step = static_cast<double>(above - lights.begin() - 1);
  const double part = above == lights.end() ? 0 : (static_cast<double>(light) - above[-1]) / (above[0] - above[-1]);
  return static_cast<float>(wide_from_ + (step + part) / kStepsWide);
}

void OutputSpace::encode_beyond(const float* rgba, std::size_t pixels, float* stored) const {
  encode(rgba, pixels, stored);
  const auto white = static_cast<float>(to_linear_(1));
  for (std::size_t i = 0; i < pixels * 4; i += 4) {
    std::array<float, 3> light{rgba[i], rgba[i + 1], rgba[i + 2]};
    to_own(light.data());
    for (std::size_t c = 0; c < 3; ++c)
      if (light[c] < darkest_ || light[c] > white) stored[i + c] = beyond(light[c]);
  }
}

const std::vector<float>& OutputSpace::of_halves() const {
  std::call_once(halves_made_, [&] {
    constexpr std::size_t kAll = 1 << 16;
    std::vector<std::uint16_t> bits(kAll);
    std::iota(bits.begin(), bits.end(), std::uint16_t{0});
    of_halves_.resize(kAll);
    floats_from_halves(bits.data(), kAll, of_halves_.data());
    for (float& value : of_halves_) value = stored_value(value);
  });
  return of_halves_;
}

void OutputSpace::encode_colors(const std::uint16_t* rgba, std::size_t pixels, float* stored) const {
  if (matrix_) {
    floats_from_halves(rgba, pixels * 4, stored);
    return encode(stored, pixels, stored);
  }
  const float* table = of_halves().data();
  for (std::size_t i = 0; i < pixels * 4; i += 4) {
    for (std::size_t c = 0; c < 3; ++c) stored[i + c] = table[rgba[i + c]];
    stored[i + 3] = 1;
  }
}

SpaceCodes space_codes(const OutputSpace& space) {
  struct Named {
    std::string_view name;
    SpaceCodes codes;
  };
  constexpr std::array kAll{Named{"rec709", {1, 1}},     Named{"srgb", {1, 13}},       Named{"gamma22", {1, 4}},
                            Named{"gamma24", {1, 2}},    Named{"linear", {1, 8}},      Named{"pq", {9, 16}},
                            Named{"hlg", {9, 18}},       Named{"hlg_1000", {9, 18}},   Named{"lin_rec2020", {9, 8}},
                            Named{"lin_p3d65", {12, 8}}, Named{"display_p3", {12, 13}}};
  for (const auto& [name, codes] : kAll)
    if (name == space.name()) return codes;
  return {};
}

bool must_be_told(const OutputSpace& space) {
  constexpr std::array<std::string_view, 5> kThese{"display_p3", "adobe_rgb", "pq", "hlg", "hlg_1000"};
  return std::ranges::find(kThese, space.name()) != kThese.end();
}

Result<const OutputSpace*> find_output_space(const std::string& name) {
  if (name.empty()) return nullptr;
  const auto space = find_input_space(name);
  if (space) return &OutputSpace::of(**space);
  Error error = space.error();
  error.message = "'" + name + "' is no output space";
  return error;
}

}  // namespace afterglow
