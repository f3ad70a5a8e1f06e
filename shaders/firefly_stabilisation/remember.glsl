// SPDX-License-Identifier: MIT
// The brightness of this frame and of the three before it.
#include "lib/color.glsl"

vec4 apply(vec4 color, vec4 before) { return vec4(brightest(color.rgb), before.rgb); }
