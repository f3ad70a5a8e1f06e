// SPDX-License-Identifier: MIT
// Which part of each image a part of the result needs. Pure functions.
#pragma once

#include <vector>

#include "graph/plan.h"

namespace afterglow {

/// Parts in pixels of the images they belong to; a part without pixels is not needed at all.
struct Regions {
  std::vector<Rect> kernels;  ///< parallel to Plan::kernels: what each has to draw of its output
  std::vector<Rect> images;   ///< parallel to Graph::images: what is read of each, or wanted of the result
};

/// What `wanted` of the result (within it, not empty) needs, found backwards through the plan: the same part of images
/// that are read pixel by pixel; of a filter's source the corresponding part and the reach of its taps; of an image
/// that a sample pass reads the corresponding part and the pass's reach, or all of it when the pass states none; all of
/// what histories keep. `blocks`, parallel to the plan's kernels: pixels that a kernel makes together (rows of an
/// invocation, a workgroup); its part begins and ends with whole ones, or at the image's edge. Empty: single pixels.
Regions regions(const Graph& graph, const Plan& plan, const Rect& wanted, const std::vector<Size>& blocks = {});

/// The smallest rectangle around both; a rectangle without pixels adds nothing.
Rect united(const Rect& a, const Rect& b);

/// False when some pass states another reach, so that regions may differ between graphs of the same structure.
bool same_reach(const Graph& a, const Graph& b);

/// What kernels do not draw, for reports: { "93.4 % of the pixels", "the region does not need them" }.
Skipped skipped_pixels(const Graph& graph, const Plan& plan, const Regions& regions);

}  // namespace afterglow
