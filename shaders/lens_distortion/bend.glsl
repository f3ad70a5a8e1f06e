// SPDX-License-Identifier: MIT
// Reads the picture at the point where the bent ray comes from; points outside read the edge, its mirror image, or nothing.
#include "lib/angle.glsl"

layout(constant_id = 0) const bool barrel = true;
layout(constant_id = 1) const bool mirrored = false;
layout(constant_id = 2) const bool black = false;

uniform sampler2D source;
uniform float theta, sigma;  // radians; 2 tan(θ/2)
uniform float bend;          // 0 leaves the scale alone
uniform vec2 center;         // −½…½
uniform vec2 axes;
uniform float inverse_scale;

vec4 sample_at(ivec2 pixel) {
  vec2 size = vec2(target_size());
  vec2 own = (vec2(2 * pixel + 1) - size) / (2.0 * size) - center;  // from the centre; sides are 1 long
  vec2 ray = axes * (own * inverse_scale);
  float r = max(length(ray), 1e-4);  // the factor is flat around the centre
  float factor = barrel ? tangent(r * theta) / (r * sigma) : arc_tangent(r * sigma) / (r * theta);
  // How far, not where: places far from the corner would lose digits.
  vec2 moved = own * (inverse_scale - 1.0) + ray * (clamp(factor, -1e4, 1e4) - 1.0) * bend;
  vec2 at = vec2(pixel) + 0.5 + moved * size;
  if (mirrored) at = abs(at - 2.0 * size * floor(at / (2.0 * size) + 0.5));
  vec3 light = fetch_linear(source, at).rgb;
  if (black) {
    vec2 inside = clamp(min(at, size - at) + 0.5, 0.0, 1.0);  // as if the pixels beyond the edge were black
    light *= inside.x * inside.y;
  }
  return vec4(light, fetch(source, pixel).a);
}
