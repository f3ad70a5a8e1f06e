// SPDX-License-Identifier: MIT
// Light times a factor.
#include "lib/color.glsl"

uniform float factor;

vec4 apply(vec4 color) { return vec4(min(color.rgb * factor, kMaxLight), color.a); }
