// SPDX-License-Identifier: MIT
// high + tint · color. Alpha of `high`.
#include "lib/color.glsl"

uniform vec3 tint;

vec4 apply(vec4 color, vec4 high) { return vec4(min(high.rgb + tint * color.rgb, vec3(kMaxLight)), high.a); }
