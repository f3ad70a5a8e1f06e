// SPDX-License-Identifier: MIT
// The sRGB transfer curve (IEC 61966-2-1), decoded by table and encoded exactly to the nearest code value.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace afterglow {

double srgb_to_linear(double encoded);  ///< odd extension below 0, the same power above 1
double linear_to_srgb(double linear);

/// Turns linear values into the code 0…max_code whose encoded value is nearest; values outside [0, 1] and NaN are
/// clamped (NaN to 0). Exact: code c is given exactly from the float on that reaches the linear value of c − ½,
/// computed in double precision. Immutable after construction, thread-safe.
class CodeEncoder {
 public:
  enum class Curve { srgb, linear };
  /// `max_code` 255, 1023, 4095 or 65535.
  CodeEncoder(Curve curve, int max_code);

  std::uint32_t operator()(float linear) const {
    // The bin of a float is given by its exponent and the first bits of its mantissa: within one, the curve is nearly a
    // line.
    if (!(linear > lowest_)) return static_cast<std::uint32_t>(linear >= thresholds_[1]);
    if (linear >= 1.0f) return max_code_;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(linear);
    const Bin& bin = bins_[(bits >> kShift) - first_bin_];
    auto code = static_cast<std::uint32_t>(bin.start + bin.slope * static_cast<float>(bits & kMask));
    while (linear < thresholds_[code]) --code;
    while (linear >= thresholds_[code + 1]) ++code;
    return code;
  }

  /// The encoder for sRGB with 255, 1023, 4095 or 65535 as its largest code; made once, kept for the life of the
  /// process.
  static const CodeEncoder& srgb(int max_code);

 private:
  static constexpr int kMantissaBits = 5, kShift = 23 - kMantissaBits;
  static constexpr std::uint32_t kMask = (1u << kShift) - 1;
  struct Bin {
    float start = 0, slope = 0;
  };
  std::uint32_t max_code_, first_bin_;
  float lowest_;
  std::vector<float> thresholds_;  ///< [c]: the smallest float of code c; [0] = −inf, [max + 1] = +inf
  std::vector<Bin> bins_;
};

/// linear[i] for code i of 0…max_code.
std::vector<float> srgb_decode_table(int max_code);

}  // namespace afterglow
