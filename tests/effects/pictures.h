// SPDX-License-Identifier: MIT
// Pictures for the tests of effects. Every value is exact in the type that the device stores, so that device and oracle
// start alike.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reference/double_image.h"

namespace afterglow {

struct Scene {
  std::string name;
  reference::DoubleImage source;
  std::optional<reference::DoubleImage> depth, normal;
  double frame = 1;                                           ///< number in a sequence
  std::optional<reference::DoubleImage> motion = {};          ///< .xy: pixels a frame, y down
  std::map<std::string, reference::DoubleImage> layers = {};  ///< by name, without "layer:"
};

/// Every value rounded to a float.
reference::DoubleImage in_floats(const reference::DoubleImage& image);

/// Even, odd and tiny.
inline const std::vector<Size> kSizes{{240, 135}, {101, 57}, {64, 64}, {17, 5}, {8, 8}, {5, 3}, {1, 6}, {9, 1}, {1, 1}};

/// Light as renders have it: log-normal around 0.3, up to about 43; colours of moderate to strong saturation; alpha in
/// 0…1. `spikes`: one pixel in 200 is at 1e4. Values are exact halves. With depth (steps from 0.5 to 1500, some 1e10)
/// and unit normals.
Scene random_scene(Size size, unsigned seed, bool spikes = false);
/// A part of tests/images/neon.exr with its depth and normals.
Scene neon_scene(Size size, int x, int y);

}  // namespace afterglow
