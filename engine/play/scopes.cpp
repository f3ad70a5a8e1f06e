// SPDX-License-Identifier: MIT
#include "play/scopes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/srgb.h"

namespace afterglow {
namespace {

constexpr std::array<double, 3> kLumaWeights{0.2126, 0.7152, 0.0722};  // Rec.709

void count_color(Scopes& scopes, const float* pixel) {
  const CodeEncoder& encoder = CodeEncoder::srgb(255);
  std::array<double, 3> code{};
  for (std::size_t c = 0; c < 3; ++c) code[c] = encoder(pixel[c]) / 255.0;
  const double luma = kLumaWeights[0] * code[0] + kLumaWeights[1] * code[1] + kLumaWeights[2] * code[2];
  const auto cell = [](double part) {
    return std::clamp(static_cast<int>((part + 0.5) * Scopes::kColors), 0, Scopes::kColors - 1);
  };
  const int cb = cell((code[2] - luma) / (2 * (1 - kLumaWeights[2])));
  const int cr = cell((code[0] - luma) / (2 * (1 - kLumaWeights[0])));
  ++scopes.colors[static_cast<std::size_t>(cr * Scopes::kColors + cb)];
}

void add(Scopes& scopes, const float* pixel, int column) {
  ++scopes.pixels;
  bool nan = false, infinite = false;
  for (int c = 0; c < 3; ++c) {
    nan = nan || std::isnan(pixel[c]);
    infinite = infinite || std::isinf(pixel[c]);
  }
  scopes.nan += nan;
  scopes.infinite += infinite && !nan;
  if (nan || infinite) return;
  bool negative = false, above = false;
  const auto count = [&](int channel, float value) {
    ++scopes.waveform[Scopes::index(channel, column, scope_level(scopes.scale, value))];
  };
  for (std::size_t c = 0; c < 3; ++c) {
    negative = negative || pixel[c] < 0;
    above = above || pixel[c] > 1;
    scopes.least[c] = std::min(scopes.least[c], pixel[c]);
    scopes.most[c] = std::max(scopes.most[c], pixel[c]);
    count(static_cast<int>(c), pixel[c]);
  }
  scopes.negative += negative;
  scopes.above_one += above;
  count(Scopes::kLuminance, 0.2126f * pixel[0] + 0.7152f * pixel[1] + 0.0722f * pixel[2]);
  count_color(scopes, pixel);
}

void sum_columns(Scopes& scopes) {
  for (int channel = 0; channel < Scopes::kChannels; ++channel) {
    auto& histogram = scopes.histogram[static_cast<std::size_t>(channel)];
    for (int column = 0; column < scopes.columns; ++column)
      for (int level = 0; level < Scopes::kLevels; ++level)
        histogram[static_cast<std::size_t>(level)] += scopes.at(channel, column, level);
  }
}

bool holds(std::span<const float> rgba, Size size) {
  return size.width > 0 && size.height > 0 &&
         rgba.size() >= static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 4;
}

}  // namespace

std::string scope_scale_name(ScopeScale scale) {
  static constexpr std::array<const char*, 3> kNames{"code", "linear", "stops"};
  return kNames[static_cast<std::size_t>(scale)];
}

int scope_level(ScopeScale scale, float linear) {
  if (scale == ScopeScale::code) return static_cast<int>(CodeEncoder::srgb(255)(linear));
  if (scale == ScopeScale::linear) {
    return static_cast<int>(std::clamp(linear > 0 ? linear : 0.0f, 0.0f, 1.0f) * 255.0f + 0.5f);
  }
  if (!(linear > 0)) return 0;
  const double position = scope_position(scale, linear);
  return static_cast<int>(std::clamp(position, 0.0, 1.0) * (Scopes::kLevels - 1) + 0.5);
}

double scope_position(ScopeScale scale, double linear) {
  switch (scale) {
    case ScopeScale::code:
      return linear_to_srgb(linear);
    case ScopeScale::linear:
      return linear;
    case ScopeScale::stops:
      break;
  }
  return (std::log2(linear / Scopes::kMiddleGrey) / Scopes::kStopsEachWay + 1) / 2;
}

std::array<double, 2> scope_color(const std::array<double, 3>& rgb) {
  std::array<double, 3> code{};
  for (std::size_t c = 0; c < 3; ++c) code[c] = std::clamp(linear_to_srgb(rgb[c]), 0.0, 1.0);
  const double luma = kLumaWeights[0] * code[0] + kLumaWeights[1] * code[1] + kLumaWeights[2] * code[2];
  return {(code[2] - luma) / (2 * (1 - kLumaWeights[2])), (code[0] - luma) / (2 * (1 - kLumaWeights[0]))};
}

Rect within(Rect region, Size picture) {
  const int x0 = std::clamp(region.x, 0, picture.width), y0 = std::clamp(region.y, 0, picture.height);
  const int x1 = std::clamp(region.x + region.width, x0, picture.width);
  const int y1 = std::clamp(region.y + region.height, y0, picture.height);
  return {x0, y0, x1 - x0, y1 - y0};
}

Scopes scopes_of(std::span<const float> rgba, Size size, const ScopeOptions& options) {
  Scopes scopes;
  scopes.scale = options.scale;
  scopes.waveform.resize(static_cast<std::size_t>(Scopes::kChannels * Scopes::kMostColumns * Scopes::kLevels));
  scopes.colors.resize(static_cast<std::size_t>(Scopes::kColors * Scopes::kColors));
  if (!holds(rgba, size)) return scopes;
  const Rect region = within(options.region.value_or(Rect{0, 0, size.width, size.height}), size);
  scopes.region = region;
  if (region.size().area() == 0) return scopes;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  scopes.least.fill(kInfinity);
  scopes.most.fill(-kInfinity);
  const double ratio =
      static_cast<double>(region.size().area()) / static_cast<double>(std::max<std::uint64_t>(options.most_pixels, 1));
  scopes.every = std::max(1, static_cast<int>(std::ceil(std::sqrt(ratio) - 1e-9)));
  // From the middle of each cell of the grid, so that no edge is preferred.
  const int every = scopes.every, x0 = std::min(every / 2, region.width - 1),
            y0 = std::min(every / 2, region.height - 1);
  const int across = (region.width - 1 - x0) / every + 1;
  scopes.columns = std::min(Scopes::kMostColumns, across);
  const auto width = static_cast<std::size_t>(size.width);
  for (int y = y0; y < region.height; y += every) {
    const float* row = &rgba[(static_cast<std::size_t>(region.y + y) * width + static_cast<std::size_t>(region.x)) * 4];
    for (int i = 0; i < across; ++i)
      add(scopes, row + static_cast<std::ptrdiff_t>(x0 + i * every) * 4,
          static_cast<int>(static_cast<std::int64_t>(i) * scopes.columns / across));
  }
  if (scopes.least[0] == kInfinity) scopes.least.fill(0);
  if (scopes.most[0] == -kInfinity) scopes.most.fill(0);
  sum_columns(scopes);
  return scopes;
}

RegionMean mean_of(std::span<const float> rgba, Size size, Rect region) {
  RegionMean out;
  if (!holds(rgba, size)) return out;
  region = within(region, size);
  for (int y = region.y; y < region.y + region.height; ++y) {
    for (int x = region.x; x < region.x + region.width; ++x) {
      const float* pixel =
          &rgba[(static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)) * 4];
      if (!std::all_of(pixel, pixel + 4, [](float v) { return std::isfinite(v); })) {
        ++out.not_finite;
        continue;
      }
      ++out.pixels;
      for (std::size_t c = 0; c < 4; ++c) out.mean[c] += pixel[c];
    }
  }
  for (double& mean : out.mean) mean /= static_cast<double>(std::max<std::uint64_t>(out.pixels, 1));
  return out;
}

}  // namespace afterglow
