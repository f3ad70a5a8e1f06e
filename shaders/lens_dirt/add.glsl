// SPDX-License-Identifier: MIT
// high + intensity · color. Alpha of `high`.
#include "lib/color.glsl"

uniform float intensity;

vec4 apply(vec4 color, vec4 high) { return vec4(min(high.rgb + intensity * color.rgb, vec3(kMaxLight)), high.a); }
