// SPDX-License-Identifier: MIT
// The brightness of this frame and of the three before it, as far as half floats go.
#include "lib/color.glsl"

vec4 apply(vec4 color, vec4 before) { return vec4(min(brightest(color.rgb), 65504.0), before.rgb); }
