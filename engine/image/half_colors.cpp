// SPDX-License-Identifier: MIT
#include "image/half_colors.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "core/half.h"

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

struct Below {
  std::uint64_t zero = 0, noise = 0;  ///< SanitizeCounts::negative, far_below
};

/// Colours below 0, and −0, become 0, alphas stay. Counts those below 0. In blocks, as above: as integers, halves with
/// a sign are negative too, and the larger the farther they are below 0.
Below hold_at_zero(std::uint16_t* rgba, std::size_t count) {
  constexpr std::size_t kBlock = 16, kBlocksAtATime = 4096;
  constexpr std::int16_t kLeast = std::numeric_limits<std::int16_t>::min();  // the bits of −0
  const auto noise = static_cast<std::int16_t>(half_from_float(-SanitizeCounts::kNoise));
  const auto hold = [noise](std::uint16_t& half, std::size_t channel, std::uint16_t& zero, std::uint16_t& far) {
    const auto value = static_cast<std::int16_t>(half);
    const std::int16_t floor = channel == 3 ? kLeast : std::int16_t{0};
    half = static_cast<std::uint16_t>(std::max(value, floor));
    zero = static_cast<std::uint16_t>(zero + (value < floor && value != kLeast));
    far = static_cast<std::uint16_t>(far + (value < floor && value > noise));
  };
  Below below;
  std::size_t i = 0;
  while (i + kBlock <= count) {
    std::array<std::uint16_t, kBlock> zero{}, far{};
    for (std::size_t blocks = 0; blocks < kBlocksAtATime && i + kBlock <= count; ++blocks, i += kBlock)
      for (std::size_t k = 0; k < kBlock; ++k) hold(rgba[i + k], k % 4, zero[k], far[k]);
    below.zero += std::accumulate(zero.begin(), zero.end(), std::uint64_t{0});
    below.noise += std::accumulate(far.begin(), far.end(), std::uint64_t{0});
  }
  std::uint16_t zero = 0, far = 0;
  for (; i < count; ++i) hold(rgba[i], i % 4, zero, far);
  below.zero += zero;
  below.noise += far;
  return below;
}

}  // namespace

bool stays_half(const ColorEncoding& encoding) {
  return encoding.curve == TransferCurve::linear && !encoding.matrix && !encoding.transform && encoding.gain == 1 &&
         !encoding.grey && encoding.alpha != AlphaKind::straight;
}

void HalfColors::take_rows(int begin, int end) {
  std::uint16_t* const first = rgba_ + static_cast<std::size_t>(begin) * width_ * 4;
  const std::size_t count = static_cast<std::size_t>(end - begin) * width_ * 4;
  const Signs signs = signs_of(first, count);
  if (signs.infinite) finite_ = false;
  if (!signs.any || signs.infinite || keep_negative_) return;
  const Below below = hold_at_zero(first, count);
  negative_ += below.zero;
  far_below_ += below.noise;
}

}  // namespace afterglow
