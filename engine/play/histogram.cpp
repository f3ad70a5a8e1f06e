// SPDX-License-Identifier: MIT
#include "play/histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/srgb.h"

namespace afterglow {
namespace {

constexpr float kMiddleGrey = 0.18f;

void count(Histogram& histogram, std::size_t channel, float value) {
  ++histogram.display[channel][static_cast<std::size_t>(display_code(value))];
  if (!(value > 0)) return;
  const double stop = std::log2(static_cast<double>(value) / kMiddleGrey) + Histogram::kStopsBelow;
  const double bin = std::clamp(std::floor(stop * Histogram::kBinsPerStop), 0.0, Histogram::kStopBins - 1.0);
  ++histogram.stops[channel][static_cast<std::size_t>(bin)];
}

void add(Histogram& histogram, const float* pixel) {
  ++histogram.pixels;
  bool nan = false, infinite = false;
  for (int c = 0; c < 3; ++c) {
    nan = nan || std::isnan(pixel[c]);
    infinite = infinite || std::isinf(pixel[c]);
  }
  if (nan) ++histogram.nan;
  if (infinite && !nan) ++histogram.infinite;
  if (nan || infinite) return;
  bool negative = false, above = false;
  for (std::size_t c = 0; c < 3; ++c) {
    negative = negative || pixel[c] < 0;
    above = above || pixel[c] > 1;
    histogram.least[c] = std::min(histogram.least[c], pixel[c]);
    histogram.most[c] = std::max(histogram.most[c], pixel[c]);
    count(histogram, c, pixel[c]);
  }
  histogram.negative += negative;
  histogram.above_one += above;
  count(histogram, 3, 0.2126f * pixel[0] + 0.7152f * pixel[1] + 0.0722f * pixel[2]);
}

}  // namespace

int display_code(float linear) { return static_cast<int>(CodeEncoder::srgb(255)(linear)); }

Histogram histogram_of(std::span<const float> rgba, Size size, std::uint64_t most_pixels) {
  Histogram histogram;
  const auto width = static_cast<std::size_t>(std::max(size.width, 0));
  const auto height = static_cast<std::size_t>(std::max(size.height, 0));
  if (rgba.size() < width * height * 4 || width * height == 0) return histogram;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  histogram.least.fill(kInfinity);
  histogram.most.fill(-kInfinity);
  const double ratio =
      static_cast<double>(width * height) / static_cast<double>(std::max<std::uint64_t>(most_pixels, 1));
  histogram.every = std::max(1, static_cast<int>(std::ceil(std::sqrt(ratio) - 1e-9)));
  const auto every = static_cast<std::size_t>(histogram.every);
  // From the middle of each cell of the grid, so that no edge is preferred.
  for (std::size_t y = std::min(every / 2, height - 1); y < height; y += every)
    for (std::size_t x = std::min(every / 2, width - 1); x < width; x += every)
      add(histogram, &rgba[(y * width + x) * 4]);
  if (histogram.least[0] == kInfinity) histogram.least.fill(0);
  if (histogram.most[0] == -kInfinity) histogram.most.fill(0);
  return histogram;
}

}  // namespace afterglow
