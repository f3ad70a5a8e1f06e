// SPDX-License-Identifier: MIT
#include "exec/convert.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

#include "core/half.h"
#include "core/parallel.h"

namespace afterglow {

namespace {

/// Pixels that are widened to RGBA at a time, on the stack.
constexpr int kChunk = 256;

void widen(const float* from, int channels, int width, float* rgba) {
  for (int x = 0; x < width; ++x) {
    for (int c = 0; c < 4; ++c) rgba[4 * x + c] = c < channels ? from[channels * x + c] : (c == 3 ? 1.0f : 0.0f);
  }
}

std::uint64_t pack_rgba(const float* rgba, int width, VkFormat format, std::byte* to) {
  const auto values = static_cast<std::size_t>(width) * 4;
  if (format == VK_FORMAT_R16G16B16A16_SFLOAT) {
    return halves_from_floats(rgba, values, reinterpret_cast<std::uint16_t*>(to));
  }
  std::memcpy(to, rgba, values * sizeof(float));
  return 0;
}

}  // namespace

std::uint64_t pack_row(const float* from, int channels, int width, VkFormat format, std::byte* to) {
  if (format == VK_FORMAT_R32_SFLOAT) {
    auto* values = reinterpret_cast<float*>(to);
    if (channels == 1) std::memcpy(values, from, static_cast<std::size_t>(width) * sizeof(float));
    for (int x = 0; channels != 1 && x < width; ++x) values[x] = from[channels * x];
    return 0;
  }
  if (channels == 4) return pack_rgba(from, width, format, to);
  const std::size_t pixel_bytes = format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8 : 16;
  std::array<float, kChunk * 4> rgba{};
  std::uint64_t held = 0;
  for (int x = 0; x < width; x += kChunk) {
    const int count = std::min(kChunk, width - x);
    widen(from + static_cast<std::ptrdiff_t>(x) * channels, channels, count, rgba.data());
    held += pack_rgba(rgba.data(), count, format, to + static_cast<std::size_t>(x) * pixel_bytes);
  }
  return held;
}

namespace {

/// Of formats with fewer than four channels; 0: no such format.
int few_channels(VkFormat format) {
  if (format == VK_FORMAT_R32_SFLOAT || format == VK_FORMAT_R16_SFLOAT) return 1;
  return format == VK_FORMAT_R32G32_SFLOAT || format == VK_FORMAT_R16G16_SFLOAT ? 2 : 0;
}

std::uint64_t unpack_few(const std::byte* from, VkFormat format, int channels, int width, float* rgba) {
  const bool half = format == VK_FORMAT_R16_SFLOAT || format == VK_FORMAT_R16G16_SFLOAT;
  std::array<float, kChunk * 2> chunk;
  std::uint64_t held = 0;
  for (int x = 0; x < width; x += kChunk) {
    const int count = std::min(kChunk, width - x);
    const auto first = static_cast<std::size_t>(x) * channels, values = static_cast<std::size_t>(count) * channels;
    if (half)
      held += floats_from_halves(from + 2 * first, values, chunk.data());
    else
      std::memcpy(chunk.data(), from + first * sizeof(float), values * sizeof(float));
    widen(chunk.data(), channels, count, rgba + static_cast<std::ptrdiff_t>(x) * 4);
  }
  return held;
}

}  // namespace

std::uint64_t unpack_row(const std::byte* from, VkFormat format, int width, float* rgba) {
  if (const int channels = few_channels(format)) return unpack_few(from, format, channels, width, rgba);
  const auto values = static_cast<std::size_t>(width) * 4;
  if (format == VK_FORMAT_R16G16B16A16_SFLOAT) return floats_from_halves(from, values, rgba);
  std::memcpy(rgba, from, values * sizeof(float));
  return 0;
}

std::uint64_t unpack_row_rgb(const std::byte* from, VkFormat format, int width, float* rgba) {
  const std::size_t pixel_bytes = format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8 : 16;
  std::array<float, kChunk * 4> chunk;
  std::uint64_t held = 0;
  for (int x = 0; x < width; x += kChunk) {
    const int count = std::min(kChunk, width - x);
    held += unpack_row(from + static_cast<std::size_t>(x) * pixel_bytes, format, count, chunk.data());
    float* to = rgba + static_cast<std::ptrdiff_t>(x) * 4;
    for (int i = 0; i < count; ++i) std::copy_n(&chunk[4 * i], 3, to + 4 * i);
  }
  return held;
}

namespace {

/// Without branches, so that it vectorises.
template <class Sample>
bool any_alpha_zero(const std::byte* from, int width) {
  const auto* samples = reinterpret_cast<const Sample*>(from);
  Sample any = 0;
  for (int x = 0; x < width; ++x) any |= static_cast<Sample>(samples[4 * x + 3] == 0);
  return any != 0;
}

}  // namespace

bool any_alpha_zero(const std::byte* from, VkFormat format, int width) {
  if (format == VK_FORMAT_R8G8B8A8_UNORM) return any_alpha_zero<std::uint8_t>(from, width);
  if (format == VK_FORMAT_R16G16B16A16_SFLOAT) return any_alpha_zero<std::uint16_t>(from, width);
  return any_alpha_zero<std::uint32_t>(from, width);
}

std::uint64_t over_rows(int rows, std::size_t bytes_per_row, const std::function<std::uint64_t(int)>& row) {
  // Below a few MiB threads cost more than they bring.
  constexpr std::size_t kBandBytes = 2u << 20;
  const auto total = static_cast<std::size_t>(rows) * bytes_per_row;
  const auto bands = std::clamp<std::size_t>(total / kBandBytes, 1, static_cast<std::size_t>(rows));
  std::atomic<std::uint64_t> sum = 0;
  const auto band = [&](std::size_t i) {
    const auto first = static_cast<int>(i * static_cast<std::size_t>(rows) / bands);
    const auto last = static_cast<int>((i + 1) * static_cast<std::size_t>(rows) / bands);
    std::uint64_t part = 0;
    for (int y = first; y < last; ++y) part += row(y);
    sum += part;
  };
  if (bands == 1)
    band(0);
  else
    parallel_for(bands, band);
  return sum;
}

}  // namespace afterglow
