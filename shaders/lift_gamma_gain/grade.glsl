// SPDX-License-Identifier: MIT
// (c·gain + lift)^power; what lift takes below black is black.
#include "lib/color.glsl"

uniform vec3 lift;
uniform vec3 power;
uniform vec3 gain;

vec4 apply(vec4 color) {
  vec3 c = clamp(color.rgb * gain + lift, 0.0, kMaxLight);
  return vec4(min(pow(c, power), kMaxLight), color.a);
}
