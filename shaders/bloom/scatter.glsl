// SPDX-License-Identifier: MIT
// Spreads light instead of adding it: amount 0 keeps `high`, 1 leaves the enlarged image of the level below. Alpha of `high`.
#include "lib/color.glsl"

uniform float amount;

vec4 apply(vec4 color, vec4 high) { return vec4(lerp(high.rgb, color.rgb, amount), high.a); }
