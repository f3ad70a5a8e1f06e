// SPDX-License-Identifier: MIT
// high + intensity · dirt · color. Alpha of `high`.
#include "lib/color.glsl"

uniform float intensity;

vec4 apply(vec4 color, vec4 high, vec4 dirt) { return vec4(min(high.rgb + intensity * dirt.r * color.rgb, vec3(kMaxLight)), high.a); }
