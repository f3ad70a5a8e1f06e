// SPDX-License-Identifier: MIT
// c · max(0, min(b, limit) − t)/b, b the largest channel: the light above a threshold, of which none counts for more than the limit.
#include "lib/color.glsl"

vec3 light_above(vec3 color, float threshold, float limit) {
  float b = brightest(color);
  return color * (max(0.0, min(b, limit) - threshold) / max(b, 1e-5));
}

/// What of a light comes back through the layers of a film. The red one is met first, whatever the colour, and green and blue get no more than it.
vec3 through_film(vec3 light) {
  float red = max(light.r, 0.4 * luminance(light)), green = min(light.g, red);
  return vec3(red, green, min(light.b, green));
}
