// SPDX-License-Identifier: MIT
// A 3×3 matrix on colours, given as the rows of its result.
#include "lib/color.glsl"

uniform vec3 red;
uniform vec3 green;
uniform vec3 blue;

vec4 apply(vec4 color) {
  vec3 c = vec3(dot(red, color.rgb), dot(green, color.rgb), dot(blue, color.rgb));
  return vec4(clamp(c, 0.0, kMaxLight), color.a);
}
