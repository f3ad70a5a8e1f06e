// SPDX-License-Identifier: MIT
// Light along a line: Σ keepⁱ · source(pixel − i · apart), times a gain, and what other rays made.
#include "lib/color.glsl"

layout(constant_id = 0) const bool add = false;

uniform sampler2D source;
uniform sampler2D sum;
uniform int reads;
uniform vec2 apart;
uniform vec3 keep, gain;

vec4 sample_at(ivec2 pixel) {
  vec2 size = vec2(target_size());
  vec3 light = vec3(0.0), share = vec3(1.0);
  for (int i = 0; i < reads; ++i) {
    vec2 at = vec2(pixel) + 0.5 - float(i) * apart;
    vec2 inside = clamp(min(at, size - at) + 0.5, 0.0, 1.0);
    if (inside.x * inside.y <= 0.0) break;
    light += share * (inside.x * inside.y) * fetch_linear(source, at).rgb;
    share *= keep;
  }
  light *= gain;
  if (add) light += fetch(sum, pixel).rgb;
  return vec4(min(light, vec3(kMaxLight)), 1.0);
}
