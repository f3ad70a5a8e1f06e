// SPDX-License-Identifier: MIT
// The light of the four pixels around each place above a threshold, then their bilinear mean: half the size.
#include "lib/bright.glsl"

layout(constant_id = 0) const bool film = false;
uniform sampler2D source;
uniform float threshold, limit;
uniform float own;  // film: how much light keeps its own colour

vec3 light_at(ivec2 pixel) {
  vec3 light = light_above(fetch(source, pixel).rgb, threshold, limit);
  return film ? mix(through_film(light), light, own) : light;
}

vec4 sample_at(ivec2 pixel) {
  // (pixel + ½) · n_src/n_dst − ½ in whole numbers: far places have as many digits as near ones.
  ivec2 twice = 2 * target_size(), place = (2 * pixel + 1) * image_size(source) - target_size();
  ivec2 first = place / twice;
  vec2 part = vec2(place - first * twice) / vec2(twice);
  vec3 above = mix(light_at(first), light_at(first + ivec2(1, 0)), part.x);
  vec3 below = mix(light_at(first + ivec2(0, 1)), light_at(first + ivec2(1, 1)), part.x);
  return vec4(mix(above, below, part.y), 1.0);
}
