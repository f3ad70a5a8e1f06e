// SPDX-License-Identifier: MIT
// Where a volume lies and how strongly it counts at a point. Pure mathematics; no Lua.
#pragma once

#include <array>

#include "script/preset.h"

namespace afterglow::script {

enum class ShapeKind { global, box, sphere };

/// In the units and axes of the scene.
struct VolumeShape {
  ShapeKind kind = ShapeKind::global;
  Position center{};
  Position size{1, 1, 1};  ///< box: whole length of each side
  Position rotation{};     ///< box: degrees about x, y and z; turned about z first, then x, then y
  double radius = 1;       ///< sphere

  /// From the point to the surface; 0 inside and for global volumes.
  double distance_to(const Position& point) const;
};

/// How much of a volume counts at this distance: clamp01(weight), times 1 − d²/B² within the blend distance B, nothing
/// beyond it. With B = 0: all of it inside, nothing outside.
double volume_factor(double weight, double distance, double blend_distance);

}  // namespace afterglow::script
