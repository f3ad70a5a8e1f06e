// SPDX-License-Identifier: MIT
// Values that are not finite: found, counted, and replaced by what a policy says. See docs/math.md §18.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "image/image.h"

namespace afterglow {

/// What takes the place of a value that is not finite (--nan-policy).
enum class NanPolicy {
  zero,       ///< of what a pass made: 0. Of a picture: as decode_color, sanitize_depth and sanitize_normal say
  neighbour,  ///< the mean of finite neighbours: see repair_from_neighbours
  fail        ///< nothing: it is an error
};

/// The first pixel of an image, in row order, that is not finite.
struct NonFinitePixel {
  int x = 0, y = 0;  ///< from the upper left corner
  int channels = 0;
  std::array<float, 4> values{};
  std::string text() const;  ///< "pixel 5,3: (nan, 0.25, inf, 1)"
};

/// What an image held. Samples are counted, not pixels.
struct NonFinite {
  std::uint64_t nan = 0, plus_infinity = 0, minus_infinity = 0;
  std::optional<NonFinitePixel> first;
  std::uint64_t count() const { return nan + plus_infinity + minus_infinity; }
  std::string text() const;  ///< "12 NaN, 3 +Inf"
};

/// Adds what a later part of the same image holds (or an earlier one: the first pixel is the first of both).
NonFinite& operator+=(NonFinite& a, const NonFinite& b);

/// One row of `width` pixels, y of the image. As fast as reading it when all are finite.
void note_non_finite(const float* row, int channels, int width, int y, NonFinite& found);
/// A whole image, over threads.
NonFinite find_non_finite(const Image& image);

/// The farthest neighbours that stand in for a value, in pixels.
inline constexpr int kNeighbourReach = 4;
/// Replaces each sample that is not finite by the mean of the finite samples of the same channel in the smallest square
/// of (2n+1)² pixels around it, 1 ≤ n ≤ kNeighbourReach, that has one; 0 when none has. Pixels outside the image are
/// none. Samples that were replaced stand in for no others.
void repair_from_neighbours(Image& image);

}  // namespace afterglow
