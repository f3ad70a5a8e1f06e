// SPDX-License-Identifier: MIT
// Effects that work over several frames, frame by frame: what one makes is given to the next.
#pragma once

#include <array>
#include <optional>

#include "reference/double_image.h"

namespace afterglow::reference {

struct AutoExposure {
  double compensation = 0, min_ev = -6, max_ev = 6;
  double low_percentile = 40, high_percentile = 90;  ///< %
  bool center = false;
  double speed_up = 4, speed_down = 2;  ///< stops a second
};
/// The exposure value that the picture asks for.
double wanted_exposure(const DoubleImage& source, const AutoExposure& settings);
/// From the exposure value of the frame before, `seconds` ago.
double adapted_exposure(double before, double wanted, double seconds, const AutoExposure& settings);
DoubleImage auto_exposure(const DoubleImage& source, double exposure, const AutoExposure& settings);

struct FireflyStabilisation {
  double threshold = 1, tolerance = 2;
  int search = 3, frames = 2;
  bool clamp_first = false;
};
/// `past`: the pictures before this one, the last one first; as many as there are, four at most.
DoubleImage firefly_stabilisation(const DoubleImage& source, const std::vector<DoubleImage>& past,
                                  const FireflyStabilisation& settings);

}  // namespace afterglow::reference
