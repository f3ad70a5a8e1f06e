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
/// that are read pixel by pixel; of a filter's source the corresponding part and the reach of its taps; of an image that
/// a sample pass reads the corresponding part and the pass's reach, or all of it when the pass states none.
Regions regions(const Graph& graph, const Plan& plan, const Rect& wanted);

/// The smallest rectangle around both; a rectangle without pixels adds nothing.
Rect united(const Rect& a, const Rect& b);

/// Pixels that the kernels of a plan draw within these regions, as a share of all they would draw.
double drawn_share(const Graph& graph, const Plan& plan, const Regions& regions);

}  // namespace afterglow
