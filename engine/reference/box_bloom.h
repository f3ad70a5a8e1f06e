// SPDX-License-Identifier: MIT
// Box-blur bloom (math.md §9), the readings of §12 #8–#11.
#pragma once

#include <vector>

#include "reference/double_image.h"

namespace afterglow::reference {

enum class BoxPattern { plus, box };
enum class BoxBrightness { max, luma };

struct BoxBloomSettings {
  double threshold = 0.8;  ///< linear
  int blur_iterations = 5;
  BoxPattern pattern = BoxPattern::plus;
  BoxBrightness brightness = BoxBrightness::max;
};

/// c · max(0, b − t)/max(b, 1e-5); no knee.
Rgb box_bloom_threshold(const Rgb& c, double threshold, BoxBrightness brightness);
/// Mean of four bilinear samples one source texel away, read at the centres of a target of `size`.
DoubleImage box_bloom_blur(const DoubleImage& source, Size size, BoxPattern pattern);

struct BoxBloomImages {
  std::vector<DoubleImage> down;  ///< E_0 (full size, thresholded), E_1, …
  std::vector<DoubleImage> blur_up,
      up;  ///< by level i = 1 … n−2 of the target (index 0 is unused and empty): blur(U), E_i + blur(U)
  DoubleImage final_up, result;
};
BoxBloomImages box_bloom(const DoubleImage& source, const BoxBloomSettings& settings);

}  // namespace afterglow::reference
