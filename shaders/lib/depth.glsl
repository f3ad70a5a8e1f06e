// SPDX-License-Identifier: MIT
/// Distance along the viewing axis from device depth 0…1; `inverse_clip` is (1/near, 1/far). 1/near and 1/far are mixed by d and 1 − d, both
/// exact, instead of (1/far − 1/near)·d + 1/near, which cancels at the far plane.
float view_distance(float device_depth, vec2 inverse_clip, bool reversed_z) {
  float d = clamp(reversed_z ? device_depth : 1.0 - device_depth, 0.0, 1.0);
  return 1.0 / (d * inverse_clip.x + (1.0 - d) * inverse_clip.y);
}
