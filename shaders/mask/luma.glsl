// SPDX-License-Identifier: MIT
#include "lib/color.glsl"
#include "lib/mask.glsl"

uniform float from;
uniform float to;
uniform float soft;

vec4 apply(vec4 color) { return vec4(in_range(luminance(straight(color)), from, to, soft)); }
