// SPDX-License-Identifier: MIT
#include "image/half_colors.h"

#include <algorithm>
#include <array>

namespace afterglow {
namespace {

constexpr std::uint16_t kSign = 0x8000, kOneOfExponent = 0x0400;

struct Signs {
  bool any = false, infinite = false;
};

/// In blocks of a fixed size without branches, so that it vectorises. One more in the exponent reaches the sign's bit
/// where the exponent is that of infinities and NaN.
Signs signs_of(const std::uint16_t* halves, std::size_t count) {
  constexpr std::size_t kBlock = 16;
  std::array<std::uint16_t, kBlock> signs{}, carried{};
  const auto carry = [](std::uint16_t half) { return static_cast<std::uint16_t>((half & ~kSign) + kOneOfExponent); };
  std::size_t i = 0;
  for (; i + kBlock <= count; i += kBlock)
    for (std::size_t k = 0; k < kBlock; ++k) {
      signs[k] = static_cast<std::uint16_t>(signs[k] | halves[i + k]);
      carried[k] = static_cast<std::uint16_t>(carried[k] | carry(halves[i + k]));
    }
  for (; i < count; ++i) {
    signs[0] = static_cast<std::uint16_t>(signs[0] | halves[i]);
    carried[0] = static_cast<std::uint16_t>(carried[0] | carry(halves[i]));
  }
  const auto has_sign = [](std::uint16_t bits) { return (bits & kSign) != 0; };
  return {std::ranges::any_of(signs, has_sign), std::ranges::any_of(carried, has_sign)};
}

}  // namespace

bool stays_half(const ColorEncoding& encoding) {
  return encoding.curve == TransferCurve::linear && !encoding.matrix && !encoding.transform && !encoding.grey &&
         encoding.alpha != AlphaKind::straight;
}

void HalfColors::take_rows(int begin, int end) {
  std::uint16_t* const first = rgba_ + static_cast<std::size_t>(begin) * width_ * 4;
  const std::size_t pixels = static_cast<std::size_t>(end - begin) * width_;
  const Signs signs = signs_of(first, pixels * 4);
  if (signs.infinite) finite_ = false;
  if (!signs.any || signs.infinite) return;
  std::uint64_t negative = 0;
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint16_t& value = first[i * 4 + c];
      negative += value > kSign;  // −0 is no less than 0
      value = (value & kSign) ? 0 : value;
    }
  negative_ += negative;
}

}  // namespace afterglow
