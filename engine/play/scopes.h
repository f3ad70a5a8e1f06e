// SPDX-License-Identifier: MIT
// How the values of a picture are spread: over its width, by colour, in all, and what is wrong with some of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace afterglow {

/// What levels of scopes count in. code: 8-bit sRGB codes. linear: 0 to 1. stops: from middle grey (0.18), −8 to +8.
enum class ScopeScale { code, linear, stops };
/// "code", "linear", "stops".
std::string scope_scale_name(ScopeScale scale);

/// Of red, green, blue and luminance (Rec.709 weights), in that order. Linear values in; alpha is not counted.
struct Scopes {
  static constexpr int kLevels = 256, kMostColumns = 256;
  static constexpr double kMiddleGrey = 0.18, kStopsEachWay = 8;
  /// Cells of the plane of colours (Cb to the right, Cr upwards, both −½ to ½ of the codes), in each direction.
  static constexpr int kColors = 256;
  enum Channel { kRed, kGreen, kBlue, kLuminance, kChannels };

  ScopeScale scale = ScopeScale::code;
  Rect region;      ///< of the picture
  int columns = 0;  ///< that its width is shared among: kMostColumns, fewer where it has fewer pixels
  std::uint32_t at(int channel, int column, int level) const { return waveform[index(channel, column, level)]; }
  std::uint32_t color_at(int cb, int cr) const { return colors[static_cast<std::size_t>(cr * kColors + cb)]; }

  /// How many pixels of a column have that level. Those beyond the scale are in its first or last one.
  std::vector<std::uint32_t> waveform;
  /// The same of all columns.
  std::array<std::array<std::uint32_t, kLevels>, kChannels> histogram{};
  /// How many pixels have that colour; rows by Cr from −½, cells by Cb from −½.
  std::vector<std::uint32_t> colors;

  std::uint64_t pixels = 0;              ///< that were looked at
  int every = 1;                         ///< of so many pixels in each direction, one was looked at
  std::uint64_t nan = 0;                 ///< pixels with a red, green or blue that is no number; counted nowhere else
  std::uint64_t infinite = 0;            ///< …that is infinite; counted nowhere else
  std::uint64_t negative = 0;            ///< pixels with a red, green or blue below 0: colours outside of Rec.709
  std::uint64_t above_one = 0;           ///< …above 1: more than a display shows
  std::array<float, 3> least{}, most{};  ///< of the finite red, green and blue

  static std::size_t index(int channel, int column, int level) {
    return static_cast<std::size_t>((channel * kMostColumns + column) * kLevels + level);
  }
};

struct ScopeOptions {
  ScopeScale scale = ScopeScale::code;
  std::optional<Rect> region;  ///< none: all of the picture; what is outside of it does not count
  std::uint64_t most_pixels = 1u << 20;
};

/// `rgba`: rows from the top without padding. Looks at no more than about `most_pixels`, in a regular grid.
Scopes scopes_of(std::span<const float> rgba, Size size, const ScopeOptions& options = {});

/// The level that a linear value counts in, 0…255; NaN in the first.
int scope_level(ScopeScale scale, float linear);
/// Where a value lies on a scale: 0…1 from its first level's middle to its last one's. For marks of axes.
double scope_position(ScopeScale scale, double linear);
/// Cb and Cr (Rec.709) of a colour by its sRGB codes, each −½…½. `rgb` are linear.
std::array<double, 2> scope_color(const std::array<double, 3>& rgb);

/// Of every pixel of a region that is finite in all four values.
struct RegionMean {
  std::array<double, 4> mean{};
  std::uint64_t pixels = 0, not_finite = 0;
};
RegionMean mean_of(std::span<const float> rgba, Size size, Rect region);

/// What of a rectangle lies within a picture.
Rect within(Rect region, Size picture);

}  // namespace afterglow
