// SPDX-License-Identifier: MIT
// Keeps the part of the light that blooms.
#include "lib/soft_knee.glsl"

uniform vec4 knee;

vec4 apply(vec4 color) { return vec4(soft_knee_threshold(color.rgb, knee), color.a); }
