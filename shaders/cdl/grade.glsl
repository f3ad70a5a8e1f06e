// SPDX-License-Identifier: MIT
// ASC CDL: (c·slope + offset)^power, then saturation around Rec.709's luma. Light is not held to 1; what offset takes below black is black.
#include "lib/color.glsl"

layout(constant_id = 0) const bool use_power = true;

uniform vec3 slope;
uniform vec3 offset;
uniform vec3 power;
uniform float saturation;

vec4 apply(vec4 color) {
  const vec3 kLuma = vec3(0.2126, 0.7152, 0.0722);
  vec3 c = clamp(color.rgb * slope + offset, 0.0, kMaxLight);
  if (use_power) c = min(pow(c, power), kMaxLight);
  return vec4(clamp(lerp(vec3(dot(c, kLuma)), c, saturation), 0.0, kMaxLight), color.a);
}
