// SPDX-License-Identifier: MIT
// Temporal anti-aliasing, frame by frame (math.md §33).
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

struct TemporalAa {
  double feedback = 0.88, bounds = 1.25;
  bool to_next = false;  ///< where motion points; else to the frame before
};
/// `before`: what this made of the frame before; null in the first. `motion`.xy: pixels, y down. `depth` may be null.
DoubleImage temporal_aa(const DoubleImage& source, const DoubleImage* before, const DoubleImage& motion,
                        const DoubleImage* depth, const TemporalAa& settings);

}  // namespace afterglow::reference
