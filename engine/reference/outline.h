// SPDX-License-Identifier: MIT
// Outlines from depth and normals (math.md §10, the readings of §12 #16–#21).
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

enum class OutlineSource { depth, device_depth, normals, mixed };
enum class OutlineDifference { offset, derivative };
enum class OutlineCombine { weighted, max };
enum class OutlineBlend { lerp, add };

struct OutlineSettings {
  OutlineSource source = OutlineSource::mixed;
  OutlineDifference difference = OutlineDifference::offset;
  bool device_depth_input =
      false;  ///< depth_space = "device": `depth` holds device depth, made linear with the next three
  double near = 0.3, far = 1000;
  bool reversed_z = true;
  OutlineCombine combine = OutlineCombine::weighted;
  double normal_factor = 0.5;
  double width = 1;             ///< pixels
  double fade_distance = 1000;  ///< where the width reaches 0; without a depth input there is no fade
  double depth_scale = 1, normal_scale = 1;
  double divide_factor = 1;
  bool level_slopes = true;  ///< offset: planes draw no line
  double contrast = 1;
  double smoothness = 0;  ///< how much 3×3 pixels decide on a line
  Rgb color{0, 0, 0};
  OutlineBlend blend = OutlineBlend::lerp;
};

/// View-space distance of device depth d.
double linear_eye_depth(double d, const OutlineSettings& settings);

/// The line's strength m ∈ [0, 1] at each pixel, in all channels. `depth` and `normal` may be null where the settings
/// don't read them.
DoubleImage outline_mask(Size size, const DoubleImage* depth, const DoubleImage* normal,
                         const OutlineSettings& settings);
/// lerp(source, color, m) or source + m·color; alpha kept.
DoubleImage outline(const DoubleImage& source, const DoubleImage* depth, const DoubleImage* normal,
                    const OutlineSettings& settings);

}  // namespace afterglow::reference
