// SPDX-License-Identifier: MIT
#include "lib/mask.glsl"

uniform float from;
uniform float to;
uniform float soft;

vec4 apply(vec4 color, vec4 depth) { return vec4(in_range(depth.r, from, to, soft)); }
