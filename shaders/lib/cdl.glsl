// SPDX-License-Identifier: MIT
// ASC CDL: (c·slope + offset)^power, then saturation around Rec.709's luma. Light is not held to 1; what offset takes below black is black.
#include "lib/color.glsl"

vec3 cdl_graded(vec3 c, vec3 slope, vec3 offset, vec3 power, float saturation, bool use_power) {
  const vec3 kLuma = vec3(0.2126, 0.7152, 0.0722);
  c = clamp(c * slope + offset, 0.0, kMaxLight);
  if (use_power) c = min(pow(c, power), kMaxLight);
  return clamp(lerp(vec3(dot(c, kLuma)), c, saturation), 0.0, kMaxLight);
}
