// SPDX-License-Identifier: MIT
#include "image/srgb.h"

#include <cmath>
#include <limits>

namespace afterglow {

double srgb_to_linear(double encoded) {
  const double x = std::abs(encoded);
  return std::copysign(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4), encoded);
}

double linear_to_srgb(double linear) {
  const double x = std::abs(linear);
  return std::copysign(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055, linear);
}

namespace {

/// Where the encoder gives codes above c: half-way between two codes, back in linear light. The two pieces of the curve
/// do not quite meet (0.0031308 encodes to 0.0404482 and 0.0404500), so the inverse is taken of the piece that encodes.
double linear_of(CodeEncoder::Curve curve, double encoded) {
  if (curve == CodeEncoder::Curve::linear) return encoded;
  constexpr double kJoin = 0.0031308;
  if (encoded <= 12.92 * kJoin) return encoded / 12.92;
  return std::max(std::pow((encoded + 0.055) / 1.055, 2.4), kJoin);
}

float first_float_at(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

}  // namespace

CodeEncoder::CodeEncoder(Curve curve, int max_code) : max_code_(static_cast<std::uint32_t>(max_code)) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  thresholds_.resize(max_code_ + 2);
  thresholds_.front() = -kInfinity;
  thresholds_.back() = kInfinity;
  for (std::uint32_t c = 1; c <= max_code_; ++c)
    thresholds_[c] = first_float_at(linear_of(curve, (c - 0.5) / max_code_));

  const auto code_of = [&](double linear) {
    return max_code_ * (curve == Curve::linear ? linear : linear_to_srgb(linear)) + 0.5;
  };
  first_bin_ = std::bit_cast<std::uint32_t>(thresholds_[1]) >> kShift;
  lowest_ = std::bit_cast<float>(first_bin_ << kShift);
  const std::uint32_t end = std::bit_cast<std::uint32_t>(1.0f) >> kShift;
  for (std::uint32_t b = first_bin_; b < end; ++b) {
    const double begin = code_of(std::bit_cast<float>(b << kShift)),
                 next = code_of(std::bit_cast<float>((b + 1) << kShift));
    bins_.push_back({static_cast<float>(begin), static_cast<float>((next - begin) / (kMask + 1))});
  }
}

const CodeEncoder& CodeEncoder::srgb(int max_code) {
  static const CodeEncoder bytes(Curve::srgb, 255), words(Curve::srgb, 65535), ten(Curve::srgb, 1023),
      twelve(Curve::srgb, 4095);
  return max_code == 255 ? bytes : max_code == 1023 ? ten : max_code == 4095 ? twelve : words;
}

std::vector<float> srgb_decode_table(int max_code) {
  std::vector<float> table(static_cast<std::size_t>(max_code) + 1);
  for (int i = 0; i <= max_code; ++i)
    table[static_cast<std::size_t>(i)] = static_cast<float>(srgb_to_linear(static_cast<double>(i) / max_code));
  return table;
}

}  // namespace afterglow
