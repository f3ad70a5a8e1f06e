// SPDX-License-Identifier: MIT
// Light that is brighter than `most` counts as if it were this bright.
#include "lib/soft_knee.glsl"

uniform float most;

vec4 apply(vec4 color) { return vec4(held_light(color.rgb, most), color.a); }
