// SPDX-License-Identifier: MIT
// How steady a look is: over the frames of a shot, and over resolutions.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/cell.h"
#include "bench/prepared_stack.h"
#include "bench/results.h"
#include "session/session.h"

namespace afterglow::bench {

/// A disc of light on a dark ground that drifts by an eighth of a pixel a frame. `radius` in pixels; each pixel has the
/// mean of its area, so that the sum of light is the same in every frame (within 1 %).
std::vector<Picture> drifting_highlight(Size size, double radius, int frames);
/// Lamps at places that are shares of the height, each pixel the mean of its area: the same scene at every size.
Picture lamps(Size size);

/// `frames` as a session runs them, under one variant of a preset.
struct ShotRequest {
  std::filesystem::path preset;
  SessionOptions options;  ///< the variant's overrides are added
  Variant variant;
  std::string scene;  ///< for the report
  double radius = 0;  ///< of the highlight, for the report; 0: not that scene
};
/// What the look adds to the pixels that do not change from frame to frame in the source (to all, where hardly any are
/// so). The first two frames are those that effects with a history begin with: they are run and not counted. Errors:
/// those of Session.
Result<TemporalCurve> measure_shot(const ShotRequest& request, const std::vector<Picture>& frames,
                                   Diagnostics& diagnostics, const Step& step);

/// What the look adds to `lamps` at each size, against the first: both as means over the pixels of the smallest, which
/// all must have the shape of. Errors: those of Session; usage (shapes differ).
Result<std::vector<ResolutionPoint>> measure_resolutions(const std::filesystem::path& preset,
                                                         const SessionOptions& options, const Variant& variant,
                                                         const std::vector<Size>& sizes, Diagnostics& diagnostics,
                                                         const Step& step);

}  // namespace afterglow::bench
