// SPDX-License-Identifier: MIT
// FidelityFX CAS: a cross of negative weights −peak·√(room/brightest), where room is what lies between the darkest of the 3×3 pixels and
// black, or the brightest and white, whichever is less.
#include "lib/color.glsl"

layout(constant_id = 0) const int apart = 1;  // pixels between those that are compared

uniform sampler2D source;
uniform float amount;
uniform float peak;  // 1/8 … 1/5

vec3 at(ivec2 pixel) { return fetch(source, pixel).rgb; }

vec4 sample_at(ivec2 pixel) {
  vec4 own = fetch(source, pixel);
  vec3 n = at(pixel + ivec2(0, -apart)), w = at(pixel + ivec2(-apart, 0)), e = at(pixel + ivec2(apart, 0)), s = at(pixel + ivec2(0, apart));
  vec3 nw = at(pixel + ivec2(-apart, -apart)), ne = at(pixel + ivec2(apart, -apart));
  vec3 sw = at(pixel + ivec2(-apart, apart)), se = at(pixel + ivec2(apart, apart));
  // The cross counts twice, so that single corners do not decide.
  vec3 low = min(min(min(n, w), min(e, s)), own.rgb), high = max(max(max(n, w), max(e, s)), own.rgb);
  low = 0.5 * (low + min(low, min(min(nw, ne), min(sw, se))));
  high = 0.5 * (high + max(high, max(max(nw, ne), max(sw, se))));
  vec3 weight = -peak * sqrt(clamp(min(low, 1.0 - high) / max(high, 1e-10), 0.0, 1.0));
  vec3 sharp = ((n + w + e + s) * weight + own.rgb) / (1.0 + 4.0 * weight);
  return vec4(lerp(own.rgb, max(sharp, 0.0), amount), own.a);
}
