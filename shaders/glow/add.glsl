// SPDX-License-Identifier: MIT
// The glow of the coarser levels and this one by its weight.
#include "lib/color.glsl"

uniform vec3 weight;

vec4 apply(vec4 color, vec4 level) { return vec4(min(color.rgb + weight * level.rgb, vec3(kMaxLight)), 1.0); }
