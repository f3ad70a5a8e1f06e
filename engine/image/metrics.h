// SPDX-License-Identifier: MIT
// How far pictures are from each other: the measure of error used everywhere in this project (math.md §13), and whether
// people would see it.
#pragma once

#include <cstddef>
#include <span>

#include "core/result.h"
#include "image/image.h"

namespace afterglow {

struct ErrorMeasure {
  double worst = 0;       ///< largest |x − ref| / (|ref| + 0.01)
  double percentile = 0;  ///< its 99.99th percentile
  double rms = 0;
  std::size_t worst_index = 0;
  std::size_t non_finite = 0;  ///< samples of x that are not finite; they count as infinite error
};
ErrorMeasure measure_error(std::span<const float> x, std::span<const double> reference);
ErrorMeasure measure_error(std::span<const float> x, std::span<const float> reference);
/// Against sizes of one's own, one a sample, in place of |ref|.
ErrorMeasure measure_error(std::span<const float> x, std::span<const float> reference, std::span<const float> sizes);

/// math.md §13: the 99.99th percentile is within the tolerance and the worst within 50 times of it.
bool within(const ErrorMeasure& error, double tolerance);

/// Yee's model of perception, as OpenImageIO has it. Share of pixels (0…1) that look different on a display. Both
/// images have 3 channels and the same size; linear light, 1 is white at 100 cd/m². Errors: io (OpenImageIO is not
/// installed), other (it failed).
Result<double> visible_difference(const Image& a, const Image& b);

}  // namespace afterglow
