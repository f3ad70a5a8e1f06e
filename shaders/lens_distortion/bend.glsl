// SPDX-License-Identifier: MIT
// Reads the picture at the point where the bent ray comes from; points outside read the edge.
#include "lib/angle.glsl"

layout(constant_id = 0) const bool barrel = true;

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
  return vec4(fetch_linear(source, vec2(pixel) + 0.5 + moved * size).rgb, fetch(source, pixel).a);
}
