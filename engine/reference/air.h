// SPDX-License-Identifier: MIT
// What lies between camera and scene, by depth: fog (math.md §29).
#pragma once

#include "reference/double_image.h"

namespace afterglow::reference {

struct DepthFog {
  double density = 0.02, start = 2;
  Rgb color{0.2, 0.23, 0.29};
  double ambient = 0.5, max_opacity = 0.85, sky = 0.25, scattering = 0.5, scattering_radius = 0.25;
  double height_falloff = 0, camera_height = 1.6, camera_pitch = 0, field_of_view = 40;
  Rgb sun_color{0};
  double sun_x = 0.5, sun_y = 0.4, sun_focus = 12;
};
/// `depth`.r: metres along the viewing axis.
DoubleImage depth_fog(const DoubleImage& source, const DoubleImage& depth, const DepthFog& settings);

}  // namespace afterglow::reference
