// SPDX-License-Identifier: MIT
#include "image/palette.h"

#include <algorithm>
#include <cstddef>

#include "image/encode.h"

namespace afterglow {
namespace {

constexpr int kBits = 5, kSide = 1 << kBits, kBins = kSide * kSide * kSide;
constexpr std::uint32_t kOpaque = 0xff000000;

struct Bin {
  std::uint64_t count = 0;
  std::array<std::uint64_t, 3> sum{};
};

int bin_of(int r, int g, int b) {
  return (r >> (8 - kBits)) << (2 * kBits) | (g >> (8 - kBits)) << kBits | b >> (8 - kBits);
}
int axis_of(int bin, int axis) { return bin >> ((2 - axis) * kBits) & (kSide - 1); }

/// Bins of a box of colours.
struct Box {
  std::vector<int> bins;
  std::uint64_t count = 0;
  int axis = 0, spread = 0;  ///< along which it is longest
};

Box box_of(std::vector<int> bins, const std::vector<Bin>& histogram) {
  Box box;
  box.bins = std::move(bins);
  for (const int bin : box.bins) box.count += histogram[static_cast<std::size_t>(bin)].count;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::ranges::minmax(box.bins, {}, [&](int bin) { return axis_of(bin, axis); });
    const int spread = axis_of(high, axis) - axis_of(low, axis);
    if (spread > box.spread) box.spread = spread, box.axis = axis;
  }
  return box;
}

/// Both halves hold as many pixels, as far as bins allow.
std::pair<Box, Box> split(Box box, const std::vector<Bin>& histogram) {
  std::ranges::sort(box.bins, {}, [&](int bin) { return std::pair(axis_of(bin, box.axis), bin); });
  std::uint64_t seen = 0;
  std::size_t at = 0;
  while (at + 1 < box.bins.size() && (at == 0 || seen * 2 < box.count))
    seen += histogram[static_cast<std::size_t>(box.bins[at++])].count;
  const auto middle = box.bins.begin() + static_cast<std::ptrdiff_t>(at);
  return {box_of({box.bins.begin(), middle}, histogram), box_of({middle, box.bins.end()}, histogram)};
}

std::uint32_t mean_color(const Box& box, const std::vector<Bin>& histogram) {
  std::array<std::uint64_t, 3> sum{};
  for (const int bin : box.bins)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += histogram[static_cast<std::size_t>(bin)].sum[c];
  const auto code = [&](std::size_t c) { return static_cast<std::uint32_t>((sum[c] + box.count / 2) / box.count); };
  return kOpaque | code(0) << 16 | code(1) << 8 | code(2);
}

std::vector<std::uint32_t> choose_colors(const std::vector<Bin>& histogram, std::size_t most) {
  std::vector<int> all;
  for (int bin = 0; bin < kBins; ++bin)
    if (histogram[static_cast<std::size_t>(bin)].count > 0) all.push_back(bin);
  if (all.empty()) return {kOpaque};
  std::vector<Box> boxes{box_of(std::move(all), histogram)};
  while (boxes.size() < most) {
    // Large ones and long ones first; a box of one bin stays.
    const auto next = std::ranges::max_element(boxes, {}, [](const Box& box) {
      return box.bins.size() < 2 ? 0 : box.count * static_cast<std::uint64_t>(box.spread * box.spread);
    });
    if (next->bins.size() < 2) break;
    auto [low, high] = split(std::move(*next), histogram);
    *next = std::move(low);
    boxes.push_back(std::move(high));
  }
  std::vector<std::uint32_t> colors;
  for (const Box& box : boxes) colors.push_back(mean_color(box, histogram));
  return colors;
}

/// The nearest colour, remembered by its bin of 6 bits.
class Nearest {
 public:
  explicit Nearest(const std::vector<std::uint32_t>& colors) : colors_(colors), known_(kCells, -1) {}
  std::uint8_t operator()(int r, int g, int b) {
    int& known = known_[static_cast<std::size_t>((r >> 2) << 12 | (g >> 2) << 6 | b >> 2)];
    if (known >= 0) return static_cast<std::uint8_t>(known);
    int best = 0, least = 1 << 30;
    for (std::size_t i = 0; i < colors_.size(); ++i) {
      const int dr = static_cast<int>(colors_[i] >> 16 & 255) - r, dg = static_cast<int>(colors_[i] >> 8 & 255) - g,
                db = static_cast<int>(colors_[i] & 255) - b;
      const int distance = 2 * dr * dr + 4 * dg * dg + db * db;
      if (distance < least) least = distance, best = static_cast<int>(i);
    }
    known = best;
    return static_cast<std::uint8_t>(best);
  }

 private:
  static constexpr std::size_t kCells = 1 << 18;
  const std::vector<std::uint32_t>& colors_;
  std::vector<int> known_;
};

}  // namespace

PalettePicture palette_picture(const PackedFrame& frame) {
  const auto channels = static_cast<std::size_t>(frame.layout->channels);
  const bool alpha = frame.layout->alpha;
  const auto pixels = static_cast<std::size_t>(frame.size.area());
  const std::uint8_t* from = frame.bytes.data();
  const auto clear = [&](std::size_t i) { return alpha && from[i * channels + 3] < 128; };
  std::vector<Bin> histogram(kBins);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (clear(i)) continue;
    const std::uint8_t* p = from + i * channels;
    Bin& bin = histogram[static_cast<std::size_t>(bin_of(p[0], p[1], p[2]))];
    ++bin.count;
    for (std::size_t c = 0; c < 3; ++c) bin.sum[c] += p[c];
  }
  const std::vector<std::uint32_t> colors = choose_colors(histogram, alpha ? 255 : 256);
  PalettePicture out;
  out.colors.fill(kOpaque);
  std::ranges::copy(colors, out.colors.begin());
  if (alpha) out.colors[255] = 0;
  out.indices.resize(pixels);
  Nearest nearest(colors);
  // A picture of few colours has each of them; one of many gets noise of about the distance between two.
  const float reach = colors.size() < 255 ? 0 : 12;
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto x = static_cast<int>(i % static_cast<std::size_t>(frame.size.width)),
               y = static_cast<int>(i / static_cast<std::size_t>(frame.size.width));
    const int noise = static_cast<int>((blue_noise(x, y) - 0.5f) * reach);
    const auto code = [&](std::size_t c) { return std::clamp(from[i * channels + c] + noise, 0, 255); };
    out.indices[i] = clear(i) ? 255 : nearest(code(0), code(1), code(2));
  }
  return out;
}

}  // namespace afterglow
