// SPDX-License-Identifier: MIT
// Ambient occlusion by depth (math.md §31).
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

enum class SurfaceNormals { from_depth, view, world };
struct Ssao {
  double intensity = 1, radius = 0.6, max_radius = 0.2;
  int samples = 16;
  double bias = 0.03, spare = 1.5;
  Rgb color{0};
  double field_of_view = 40;
  SurfaceNormals normals = SurfaceNormals::from_depth;
  Rgb camera_forward{0, 1, 0}, camera_up{0, 0, 1};
};
/// Half-sized: direction of each second pixel's surface in the camera's space, and its distance (alpha). `normal` may
/// be null when normals come from depth.
DoubleImage ssao_surface(const DoubleImage& depth, const DoubleImage* normal, const Ssao& settings);
/// Share of light that is left; distance in alpha.
DoubleImage ssao_occlusion(const DoubleImage& surface, Size picture, const Ssao& settings);
DoubleImage ssao(const DoubleImage& source, const DoubleImage& depth, const DoubleImage* normal, const Ssao& settings);

}  // namespace afterglow::reference
