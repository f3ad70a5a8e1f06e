// SPDX-License-Identifier: MIT
// The bloom pyramid (math.md §3–§5), each pass alone and the whole with all its intermediates.
// Alpha: images of the pyramid carry none that means anything; what a combine returns has the alpha of its `high`.
#pragma once

#include <vector>

#include "reference/double_image.h"

namespace afterglow::reference {

enum class BloomMode { additive, scattering };

struct BloomSettings {
  BloomMode mode = BloomMode::additive;
  int max_iterations = 16;
  int downscale_limit = 2;  ///< pixels
  double threshold = 1.0;   ///< a gamma value
  double knee = 0.5;
  double intensity = 0.2;
  double scatter = 0.7;
  bool bicubic_upsampling = true;
  bool fade_fireflies = false;
  int reference_height = 0;  ///< pixels; 0: the pyramid is built on the picture as it is
  double clamp = 0;          ///< the brightest channel that glows in full; 0: any
  Edges edges = Edges::stretch;
};

/// A picture's size if it were of this height.
Size bloom_scaled_size(Size size, int height);
/// The picture as it would be at this size: halved while that leaves at least as much on both sides, then the mean of
/// bilinear reads at most half a texel apart over what is left.
DoubleImage bloom_scaled(const DoubleImage& source, Size wanted);

/// The soft-knee threshold T(c) = c · max(s, b − t)/max(b, 1e-5), b the largest channel, s the quadratic knee between
/// t(1−k) and t(1+k).
struct BloomThreshold {
  double t = 1;  ///< linear
  double knee = 0.5;
  double clamp = 0;
  static BloomThreshold from_gamma(double threshold, double knee);
  Rgb operator()(const Rgb& c) const;
};

/// T of the bilinear sample at half size.
DoubleImage bloom_prefilter(const DoubleImage& source, const BloomThreshold& threshold);
/// Half size; five thresholded samples on a diagonal cross, weighted by 1/(luminance + 1).
DoubleImage bloom_prefilter_fireflies(const DoubleImage& source, const BloomThreshold& threshold);
/// The same at another size; at the source's own, single pixels.
DoubleImage bloom_fade_fireflies(const DoubleImage& source, Size size, const BloomThreshold& threshold);
/// Halves both axes; Gaussian on x (9 samples, two texels apart).
DoubleImage bloom_horizontal(const DoubleImage& source, Edges edges = Edges::stretch);
/// Same size; Gaussian on y (5 samples between texels).
DoubleImage bloom_vertical(const DoubleImage& source, Edges edges = Edges::stretch);

/// `low` enlarged to `size`, bicubic or bilinear.
DoubleImage bloom_up(const DoubleImage& low, Size size, bool bicubic, Edges edges = Edges::stretch);
/// high + I·up
DoubleImage bloom_add(const DoubleImage& up, const DoubleImage& high, double intensity);
/// lerp(high, up, amount)
DoubleImage bloom_scatter(const DoubleImage& up, const DoubleImage& high, double amount);
/// lerp(high, up + high − T(high), I): gives back the light that the threshold took.
DoubleImage bloom_scatter_final(const DoubleImage& up, const DoubleImage& high, double intensity,
                                const BloomThreshold& threshold);

struct BloomImages {
  bool ran = false;  ///< false: skipped (math.md §5 step 1); `result` is the source, the rest empty
  DoubleImage prefilter;
  std::vector<DoubleImage> horizontal, vertical;  ///< by level, 0 the finest (a quarter of the picture)
  std::vector<DoubleImage> up, combine;           ///< by level of the target: 0 … levels−2
  DoubleImage final_up, result;
};
BloomImages bloom(const DoubleImage& source, const BloomSettings& settings);

/// Sizes of prefilter and levels for a picture, the prefilter first; empty when bloom is skipped for `size`.
std::vector<Size> bloom_sizes(Size size, int max_iterations, int downscale_limit);

}  // namespace afterglow::reference
