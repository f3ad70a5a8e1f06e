// SPDX-License-Identifier: MIT
#include "api/pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "api/call.h"
#include "core/half.h"
#include "gpu/image.h"
#include "image/encode.h"
#include "image/picture.h"
#include "image/reader.h"
#include "image/srgb.h"

namespace afterglow::api {
namespace {

/// With it no place of a picture overflows; pictures in memory have less.
constexpr std::ptrdiff_t kLargestStride = std::ptrdiff_t{1} << 46;
bool in_reach(std::ptrdiff_t stride) { return stride >= -kLargestStride && stride <= kLargestStride; }

constexpr float kFarDepth = 1e10f;  // as image/color_encoding.cpp has it

struct Allowed {
  int least, most;
};
Allowed channels_of(ImageRole role) {
  switch (role) {
    case ImageRole::color:
      return {3, 4};
    case ImageRole::depth:
      return {1, 1};
    case ImageRole::normal:
      return {3, 4};
    case ImageRole::motion:
      return {2, 4};
  }
  return {1, 4};
}

/// Pixels that do not lie one behind the other, brought together.
void gather(const Pixels& p, int y, void* packed) {
  const std::size_t bytes = p.sample_bytes() * static_cast<std::size_t>(p.channels);
  auto* to = static_cast<std::byte*>(packed);
  if (p.packed()) {
    std::memcpy(to, p.at(0, y), bytes * static_cast<std::size_t>(p.size.width));
    return;
  }
  for (int x = 0; x < p.size.width; ++x) std::memcpy(to + static_cast<std::size_t>(x) * bytes, p.at(x, y), bytes);
}

void read_floats(const Pixels& p, int y, float* row) {
  if (p.samples == AFTERGLOW_FLOAT) return gather(p, y, row);
  thread_local std::vector<std::uint16_t> halves;
  const auto count = static_cast<std::size_t>(p.size.width) * static_cast<std::size_t>(p.channels);
  halves.resize(count);
  gather(p, y, halves.data());
  floats_from_halves(halves.data(), count, row);
}

/// From the back, so that the row may hold three channels at first.
void add_alpha(float* row, int width) {
  for (int x = width - 1; x >= 0; --x) {
    for (int c = 2; c >= 0; --c) row[x * 4 + c] = row[x * 3 + c];
    row[x * 4 + 3] = 1;
  }
}

/// As OpenImageIO makes it of files: a product, which is not always the quotient's float.
float alpha_of(std::uint8_t code) { return static_cast<float>(code) * (1.0f / 255.0f); }

void decode_codes(const Pixels& p, int y, float* row) {
  static const std::vector<float> linear = srgb_decode_table(255);
  for (int x = 0; x < p.size.width; ++x, row += 4) {
    const auto* codes = reinterpret_cast<const std::uint8_t*>(p.at(x, y));
    const float alpha = p.channels == 4 ? alpha_of(codes[3]) : 1.0f;
    for (int c = 0; c < 3; ++c) row[c] = linear[codes[c]] * alpha;
    row[3] = alpha;
  }
}

std::uint64_t total(const SanitizeCounts& counts) {
  return counts.nan + counts.negative + counts.too_large + counts.alpha;
}

void read_color(const Pixels& p, bool keep_negative, int y, float* row, Mended& mended) {
  if (p.samples == AFTERGLOW_UINT8) return decode_codes(p, y, row);
  read_floats(p, y, row);
  if (p.channels == 3) add_alpha(row, p.size.width);
  SanitizeCounts counts;
  sanitize_color(row, static_cast<std::size_t>(p.size.width), counts, keep_negative);
  if (const auto sum = total(counts)) mended += sum;
}

/// Non-finite depths are far away; a normal or motion that is not finite is none.
void read_auxiliary(const Pixels& p, ImageRole role, int y, float* row, Mended& mended) {
  read_floats(p, y, row);
  std::uint64_t sum = 0;
  for (int x = 0; x < p.size.width; ++x) {
    float* pixel = row + x * p.channels;
    if (std::all_of(pixel, pixel + p.channels, [](float v) { return std::isfinite(v); })) continue;
    std::fill_n(pixel, p.channels, role == ImageRole::depth ? kFarDepth : 0.0f);
    ++sum;
  }
  flush_smallest(row, static_cast<std::size_t>(p.size.width) * static_cast<std::size_t>(p.channels));
  if (sum) mended += sum;
}

/// The source's alpha of one pixel as the stack has it.
float alpha_at(const Pixels& p, int x, int y) {
  if (p.channels < 4) return 1;
  const std::byte* pixel = p.at(x, y);
  if (p.samples == AFTERGLOW_UINT8) return alpha_of(std::to_integer<std::uint8_t>(pixel[3]));
  float alpha;
  if (p.samples == AFTERGLOW_HALF) {
    std::uint16_t half;
    std::memcpy(&half, pixel + 6, sizeof half);
    alpha = float_from_half(half);
  } else {
    std::memcpy(&alpha, pixel + 12, sizeof alpha);
  }
  return std::abs(alpha) <= kLargestColor ? alpha : 1;
}

/// In pieces that a C library copies through the caches: longer ones it writes past them (`rep movsb`), which costs
/// half as much again where the caller's pixels are in them.
void copy_in_pieces(std::byte* to, const std::byte* from, std::size_t bytes) {
  constexpr std::size_t kPiece = 1024;
  for (std::size_t at = 0; at < bytes; at += kPiece) std::memcpy(to + at, from + at, std::min(kPiece, bytes - at));
}

/// Packed samples of `channels` each into the caller's pixels.
void scatter(const Pixels& to, int x, int y, int width, const void* packed) {
  const std::size_t bytes = to.sample_bytes() * static_cast<std::size_t>(to.channels);
  const auto* from = static_cast<const std::byte*>(packed);
  if (to.packed()) {
    copy_in_pieces(to.at(x, y), from, bytes * static_cast<std::size_t>(width));
    return;
  }
  for (int i = 0; i < width; ++i) std::memcpy(to.at(x + i, y), from + static_cast<std::size_t>(i) * bytes, bytes);
}

template <class Sample>
void drop_alpha(Sample* samples, int width) {
  for (int x = 1; x < width; ++x)
    for (int c = 0; c < 3; ++c) samples[x * 3 + c] = samples[x * 4 + c];
}

std::uint64_t write_floats(const ResultRules& rules, int x, int y, int width, const float* rgba) {
  const Pixels& to = rules.to;
  thread_local std::vector<float> row;
  thread_local std::vector<std::uint16_t> halves;
  thread_local std::vector<std::uint8_t> codes;
  const auto samples = static_cast<std::size_t>(width) * static_cast<std::size_t>(to.channels);
  if (to.samples == AFTERGLOW_UINT8) {
    codes.resize(samples);
    encode_row({.max_code = 255, .alpha = to.channels == 4, .dither = rules.dither}, rgba, width, x, y, codes.data());
    scatter(to, x, y, width, codes.data());
    return 0;
  }
  if (to.channels == 3) {
    row.assign(rgba, rgba + static_cast<std::ptrdiff_t>(width) * 4);
    drop_alpha(row.data(), width);
    rgba = row.data();
  }
  if (to.samples == AFTERGLOW_FLOAT) {
    scatter(to, x, y, width, rgba);
    return 0;
  }
  halves.resize(samples);
  const std::uint64_t held = to_half(rgba, halves.data(), samples);
  scatter(to, x, y, width, halves.data());
  return held;
}

std::uint64_t write_row(const ResultRules& rules, int x, int y, int width, VkFormat format, const std::byte* from) {
  thread_local std::vector<float> floats;
  thread_local std::vector<std::uint8_t> codes;
  if (format == VK_FORMAT_R8G8B8A8_UNORM) {
    const auto* rgba = reinterpret_cast<const std::uint8_t*>(from);
    if (rules.to.channels == 3) {
      codes.assign(rgba, rgba + static_cast<std::ptrdiff_t>(width) * 4);
      drop_alpha(codes.data(), width);
      rgba = codes.data();
    }
    scatter(rules.to, x, y, width, rgba);
    return 0;
  }
  if (format == VK_FORMAT_R32G32B32A32_SFLOAT)
    return write_floats(rules, x, y, width, reinterpret_cast<const float*>(from));
  floats.resize(static_cast<std::size_t>(width) * 4);
  const std::uint64_t held = floats_from_halves(from, floats.size(), floats.data());
  for (int i = 0; i < width; ++i) floats[static_cast<std::size_t>(i) * 4 + 3] = alpha_at(rules.source, x + i, y);
  return held + write_floats(rules, x, y, width, floats.data());
}

}  // namespace

Result<void> check_size(Size size) {
  constexpr int most = AFTERGLOW_LARGEST_SIDE;
  static_assert(most == SizeLimits().max_side, "afterglow.h says another largest side than files may have");
  if (std::min(size.width, size.height) >= 1 && std::max(size.width, size.height) <= most) return {};
  return usage(fmt::format("{}×{} pixels; sides go from 1 to {}", size.width, size.height, most));
}

Result<Pixels> check_image(const afterglow_image& given, ImageRole role, const char* name) {
  const auto fail = [&](const std::string& why) { return usage(fmt::format("image '{}': {}", name, why)); };
  if (!given.data) return fail("data is NULL");
  if (auto fits = check_size({given.width, given.height}); !fits) return fail(fits.error().message);
  const auto [least, most] = channels_of(role);
  if (given.channels < least || given.channels > most)
    return fail(fmt::format("{} channels; allowed: {}", given.channels,
                            least == most ? std::to_string(least) : fmt::format("{} to {}", least, most)));
  const bool known = given.samples == AFTERGLOW_FLOAT || given.samples == AFTERGLOW_HALF ||
                     (given.samples == AFTERGLOW_UINT8 && role == ImageRole::color);
  if (!known) return fail(role == ImageRole::color ? "unknown samples" : "samples must be floats or halves");
  Pixels out{.data = static_cast<std::byte*>(given.data),
             .size = {given.width, given.height},
             .channels = given.channels,
             .samples = given.samples};
  const auto pixel_bytes = static_cast<std::ptrdiff_t>(out.sample_bytes() * static_cast<std::size_t>(out.channels));
  out.pixel_stride = given.pixel_stride == 0 ? pixel_bytes : given.pixel_stride;
  if (out.pixel_stride < pixel_bytes) return fail(fmt::format("pixel_stride is less than {} bytes", pixel_bytes));
  if (!in_reach(out.pixel_stride) || !in_reach(given.row_stride)) return fail("a stride is more than 2^46 bytes");
  out.row_stride = given.row_stride == 0 ? out.pixel_stride * given.width : given.row_stride;
  if (std::abs(out.row_stride) < out.pixel_stride * (given.width - 1) + pixel_bytes)
    return fail("row_stride is less than a row");
  return out;
}

HostImage color_image(const Pixels& pixels, bool keep_negative, Mended& mended) {
  HostImage out;
  out.size = pixels.size;
  out.channels = 4;
  out.read_row = [=, &mended](int y, float* row) { read_color(pixels, keep_negative, y, row, mended); };
  return out;
}

HostImage auxiliary_image(const Pixels& pixels, ImageRole role, Mended& mended) {
  HostImage out;
  out.size = pixels.size;
  out.channels = pixels.channels;
  out.read_row = [=, &mended](int y, float* row) { read_auxiliary(pixels, role, y, row, mended); };
  return out;
}

HostResult result_rows(const ResultRules& rules) {
  HostResult out;
  out.write_row = [rules](int x, int y, int width, VkFormat format, const std::byte* from) -> std::uint64_t {
    const Rect& r = rules.region;
    if (y < r.y || y >= r.y + r.height) return 0;
    const int begin = std::max(x, r.x), end = std::min(x + width, r.x + r.width);
    if (begin >= end) return 0;
    return write_row(rules, begin, y, end - begin, format,
                     from + static_cast<std::size_t>(begin - x) * bytes_per_pixel(format));
  };
  return out;
}

}  // namespace afterglow::api
