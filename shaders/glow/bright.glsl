// SPDX-License-Identifier: MIT
// The light of each pixel above a threshold.
#include "lib/bright.glsl"

layout(constant_id = 0) const bool film = false;
uniform float threshold, limit;
uniform float own;  // film: how much light keeps its own colour

vec4 apply(vec4 color) {
  vec3 light = light_above(color.rgb, threshold, limit);
  return vec4(film ? mix(through_film(light), light, own) : light, 1.0);
}
