// SPDX-License-Identifier: MIT
#include "image/color_encoding.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <tuple>

#include "core/parallel.h"
#include "image/hlg_rendering.h"
#include "image/plain_values.h"
#include "image/srgb.h"

namespace afterglow {
namespace {

constexpr float kFarDepth = 1e10f;

SanitizeCounts& operator+=(SanitizeCounts& a, const SanitizeCounts& b) {
  a.nan += b.nan;
  a.negative += b.negative;
  a.far_below += b.far_below;
  a.too_large += b.too_large;
  a.alpha += b.alpha;
  a.depth += b.depth;
  a.normal += b.normal;
  return a;
}

/// A curve at 65536 steps for each unit of stored values from −0.25 to 1.25, between which it is straight to 1e-7.
class DenseCurve {
 public:
  static constexpr float kFirst = -0.25f, kLast = 1.25f, kSteps = 65536;
  explicit DenseCurve(const std::function<float(double)>& curve) {
    values_.resize(static_cast<std::size_t>((kLast - kFirst) * kSteps) + 2);
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = curve(kFirst + static_cast<double>(i) / kSteps);
  }
  static bool holds(float stored) { return stored >= kFirst && stored <= kLast; }
  float operator()(float stored) const {
    const float position = (stored - kFirst) * kSteps;
    const auto index = static_cast<std::size_t>(position);
    const float t = position - static_cast<float>(index);
    return values_[index] + (values_[index + 1] - values_[index]) * t;
  }

 private:
  std::vector<float> values_;
};

/// Made once for each curve: there are few.
const DenseCurve& dense_curve(const ColorEncoding& encoding, const std::function<float(double)>& curve) {
  using Key = std::tuple<TransferCurve, double, double (*)(double)>;
  static std::mutex mutex;
  static std::map<Key, DenseCurve> made;
  const std::lock_guard lock(mutex);
  const Key key{encoding.curve, encoding.exponent, encoding.formula};
  return made.try_emplace(key, curve).first->second;
}

/// A decoder of single samples, by table where there are few codes.
class CurveDecoder {
 public:
  explicit CurveDecoder(const ColorEncoding& encoding) : encoding_(encoding) {
    if (encoding.curve == TransferCurve::linear || encoding.transform) return;
    if (encoding.dense && encoding.curve != TransferCurve::tables)
      dense_ = &dense_curve(encoding, [this](double stored) { return formula(stored); });
    if (encoding.curve == TransferCurve::tables) {
      for (int c = 0; c < 3; ++c) tables_[c] = &encoding.tables[c];
    } else if (encoding.max_code > 0) {
      shared_.resize(static_cast<std::size_t>(encoding.max_code) + 1);
      for (std::size_t i = 0; i < shared_.size(); ++i) shared_[i] = formula(static_cast<double>(i) / encoding.max_code);
      for (auto& table : tables_) table = &shared_;
    }
  }

  bool identity() const { return encoding_.curve == TransferCurve::linear || encoding_.transform; }

  float operator()(int channel, float stored) const {
    if (dense_ && DenseCurve::holds(stored)) return (*dense_)(stored);
    const std::vector<float>* table = tables_[channel];
    if (!table) return formula(stored);
    const auto last = static_cast<float>(table->size() - 1);
    const float position = std::clamp(stored, 0.0f, 1.0f) * last;
    // Stored codes hit the table; the product above is off by up to 0.01 of 65535. Values between them (divided by
    // alpha) are interpolated.
    const int nearest = static_cast<int>(position + 0.5f);
    if (std::abs(position - static_cast<float>(nearest)) < 0.02f) return (*table)[static_cast<std::size_t>(nearest)];
    const auto index = static_cast<std::size_t>(position);
    const float t = position - static_cast<float>(index);
    return (*table)[index] * (1 - t) + (*table)[index + 1] * t;
  }

 private:
  float formula(double stored) const {
    switch (encoding_.curve) {
      case TransferCurve::srgb:
        return static_cast<float>(srgb_to_linear(stored));
      case TransferCurve::rec709:
        return static_cast<float>(stored < 0.081 ? stored / 4.5 : std::pow((stored + 0.099) / 1.099, 1 / 0.45));
      case TransferCurve::power:
        return static_cast<float>(std::copysign(std::pow(std::abs(stored), encoding_.exponent), stored));
      case TransferCurve::formula:
        return static_cast<float>(encoding_.formula(stored));
      default:
        return static_cast<float>(stored);
    }
  }

  const ColorEncoding& encoding_;
  const DenseCurve* dense_ = nullptr;
  std::vector<float> shared_;
  std::array<const std::vector<float>*, 3> tables_{};
};

void make_finite(float& value, SanitizeCounts& counts) {
  if (std::isnan(value)) {
    value = 0;
    ++counts.nan;
  } else if (value > kLargestColor) {
    value = kLargestColor;
    ++counts.too_large;
  } else if (value < -kLargestColor) {  // −infinity would become NaN in a matrix
    value = 0;
    ++counts.negative;
    ++counts.far_below;
  }
}

void make_alpha_finite(float& alpha, SanitizeCounts& counts) {
  if (std::abs(alpha) <= kLargestColor) return;
  alpha = 1;
  ++counts.alpha;
}

/// Finite colours on both sides of 0.
void keep_finite(float* rgba, std::size_t pixels, SanitizeCounts& counts) {
  for (std::size_t i = 0; i < pixels; ++i) {
    float* pixel = rgba + i * 4;
    for (int c = 0; c < 3; ++c) make_finite(pixel[c], counts);
    make_alpha_finite(pixel[3], counts);
  }
  flush_smallest(rgba, pixels * 4);
}

/// The common case, linear Rec.709 with associated alpha. Blocks with nothing to mend are only read; the others take
/// one pass without branches, so that it vectorises.
void sanitize_linear(float* rgba, std::size_t pixels, SanitizeCounts& counts) {
  std::uint64_t nan = 0, negative = 0, far_below = 0, large = 0, alpha = 0;
  constexpr std::size_t kBlock = 1024;  // 32-bit counters inside a block keep all lanes equally wide
  for (std::size_t begin = 0; begin < pixels; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, pixels);
    if (all_plain(rgba + begin * 4, (end - begin) * 4)) continue;
    std::uint32_t block_nan = 0, block_negative = 0, block_far = 0, block_large = 0, block_alpha = 0;
    for (std::size_t i = begin; i < end; ++i) {
      float* pixel = rgba + i * 4;
      for (int c = 0; c < 3; ++c) {
        const float v = pixel[c];
        block_nan += v != v;
        block_negative += v < 0;
        block_far += v < -SanitizeCounts::kNoise;
        block_large += v > kLargestColor;
        const float positive = v >= kSmallestColor ? v : 0.0f;  // NaN fails the test
        pixel[c] = positive < kLargestColor ? positive : kLargestColor;
      }
      const bool finite =
          std::abs(pixel[3]) <= kLargestColor;  // as light: filters sum alpha too, and must not overflow
      block_alpha += !finite;
      pixel[3] = finite ? pixel[3] : 1.0f;
    }
    nan += block_nan;
    negative += block_negative;
    far_below += block_far;
    large += block_large;
    alpha += block_alpha;
  }
  counts.nan += nan;
  counts.negative += negative;
  counts.far_below += far_below;
  counts.too_large += large;
  counts.alpha += alpha;
}

void decode_rows(const ColorEncoding& encoding, const CurveDecoder& curve, float* rgba, std::size_t pixels,
                 SanitizeCounts& counts) {
  if (encoding.grey)
    for (std::size_t i = 0; i < pixels; ++i) rgba[i * 4 + 1] = rgba[i * 4 + 2] = rgba[i * 4];
  if (encoding.alpha == AlphaKind::none)
    for (std::size_t i = 0; i < pixels; ++i) rgba[i * 4 + 3] = 1;
  if (encoding.data) {
    for (std::size_t i = 0; i < pixels * 4; ++i) {
      float& value = rgba[i];
      counts.nan += std::isnan(value);
      value = std::isnan(value) ? 0.0f : std::clamp(value, -kLargestColor, kLargestColor);
    }
    return;
  }
  const auto sanitize = encoding.keep_negative ? keep_finite : sanitize_linear;
  const bool straight = encoding.alpha == AlphaKind::straight;
  // Associated integers were multiplied after they had been encoded: divide first, multiply again in linear light.
  const bool divide = encoding.alpha == AlphaKind::associated && (!curve.identity() || encoding.transform);
  if (curve.identity() && !encoding.matrix && !encoding.transform && !straight && encoding.gain == 1)
    return sanitize(rgba, pixels, counts);

  for (std::size_t i = 0; i < pixels; ++i) {
    float* pixel = rgba + i * 4;
    for (int c = 0; c < 3; ++c) make_finite(pixel[c], counts);
    make_alpha_finite(pixel[3], counts);
    if (divide && pixel[3] > 0)
      for (int c = 0; c < 3; ++c) pixel[c] /= pixel[3];
    if (!curve.identity())
      for (int c = 0; c < 3; ++c) pixel[c] = curve(c, pixel[c]);
  }
  if (encoding.transform) {
    std::vector<float> rgb(pixels * 3);
    for (std::size_t i = 0; i < pixels; ++i) std::copy_n(rgba + i * 4, 3, &rgb[i * 3]);
    encoding.transform->apply(rgb.data(), pixels);
    for (std::size_t i = 0; i < pixels; ++i) std::copy_n(&rgb[i * 3], 3, rgba + i * 4);
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    float* pixel = rgba + i * 4;
    if (encoding.hlg_display) hlg_to_display(pixel);
    if (encoding.matrix) multiply(*encoding.matrix, pixel, pixel);
    if (encoding.gain != 1)
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(pixel[c] * encoding.gain);
    if (straight || (divide && pixel[3] > 0))
      for (int c = 0; c < 3; ++c) pixel[c] *= pixel[3];
  }
  sanitize(rgba, pixels, counts);
}

}  // namespace

void sanitize_color(float* rgba, std::size_t pixels, SanitizeCounts& counts, bool keep_negative) {
  (keep_negative ? keep_finite : sanitize_linear)(rgba, pixels, counts);
}

void decode_color(const ColorEncoding& encoding, float* rgba, std::size_t pixels, SanitizeCounts& counts) {
  decode_rows(encoding, CurveDecoder(encoding), rgba, pixels, counts);
}

std::function<void(int begin, int end)> decoder_of_rows(const ColorEncoding& encoding, Image& rgba,
                                                        SanitizeCounts& counts, NonFinite* found) {
  const auto curve = std::make_shared<const CurveDecoder>(encoding);
  const auto mutex = std::make_shared<std::mutex>();
  return [&encoding, &rgba, &counts, found, curve, mutex](int begin, int end) {
    SanitizeCounts own;
    NonFinite own_found;
    for (int y = begin; y < end; ++y) {
      if (found) note_non_finite(rgba.at(0, y), rgba.channels, rgba.width, y, own_found);
      decode_rows(encoding, *curve, rgba.at(0, y), static_cast<std::size_t>(rgba.width), own);
    }
    const std::lock_guard lock(*mutex);
    counts += own;
    if (found) *found += own_found;
  };
}

void decode_color(const ColorEncoding& encoding, Image& rgba, SanitizeCounts& counts, NonFinite* found) {
  parallel_rows(rgba.height, static_cast<long long>(rgba.pixels.size()),
                decoder_of_rows(encoding, rgba, counts, found));
}

void sanitize_depth(Image& depth, SanitizeCounts& counts) {
  for (float& value : depth.pixels) {
    if (std::isfinite(value)) continue;
    value = kFarDepth;
    ++counts.depth;
  }
}

void sanitize_normal(Image& normal, SanitizeCounts& counts) {
  for (std::size_t i = 0; i + 3 <= normal.pixels.size(); i += 3) {
    float* n = &normal.pixels[i];
    if (std::isfinite(n[0]) && std::isfinite(n[1]) && std::isfinite(n[2])) continue;
    n[0] = n[1] = n[2] = 0;
    ++counts.normal;
  }
}

void flush_smallest(float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) values[i] = std::abs(values[i]) < kSmallestColor ? 0.0f : values[i];
}

}  // namespace afterglow
