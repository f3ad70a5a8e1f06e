#include "exec/brightest.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "exec/half.h"

namespace afterglow {

namespace {

constexpr std::uint32_t kLargestFinite = 0x7f7fffff;

/// Largest bits of each lane, four floats at a time: what compilers make vector instructions of.
std::array<std::uint32_t, 4> largest_lanes(const float* from, std::size_t quads) {
  std::array<std::uint32_t, 4> lanes{};
  for (std::size_t i = 0; i < quads; ++i)
    for (std::size_t lane = 0; lane < 4; ++lane)
      lanes[lane] = std::max(lanes[lane], std::bit_cast<std::uint32_t>(from[4 * i + lane]));
  return lanes;
}

std::uint32_t largest_bits(const float* row, int channels, int width) {
  if (channels == 4) {
    const auto lanes = largest_lanes(row, static_cast<std::size_t>(width));
    return std::max({lanes[0], lanes[1], lanes[2]});
  }
  std::uint32_t largest = 0;
  for (std::ptrdiff_t x = 0; x < width; ++x)
    for (int c = 0; c < std::min(channels, 3); ++c)
      largest = std::max(largest, std::bit_cast<std::uint32_t>(row[x * channels + c]));
  return largest;
}

}  // namespace

void Brightest::add_row(const float* row, int channels, int width) {
  const std::uint32_t row_bits = largest_bits(row, channels, width);
  std::uint32_t known = bits_.load(std::memory_order_relaxed);
  while (known < row_bits && !bits_.compare_exchange_weak(known, row_bits, std::memory_order_relaxed)) {
  }
}

float Brightest::value(Storage storage) const {
  const std::uint32_t bits = bits_.load();
  if (bits > kLargestFinite) return std::numeric_limits<float>::quiet_NaN();
  const auto value = std::bit_cast<float>(bits);
  // Rounding keeps the order: the largest stays the largest.
  return storage == Storage::fp16 ? float_from_half(half_from_float(value)) : value;
}

}  // namespace afterglow
