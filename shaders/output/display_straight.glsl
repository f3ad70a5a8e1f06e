// SPDX-License-Identifier: MIT
// The last step to an 8-bit display file with transparency: colours are divided by the alpha of the original picture, which no effect
// changes, in linear light; where it is 0 they stay undivided, and above 1, which no code holds, too. The nearest codes.
#include "lib/display.glsl"

vec4 apply(vec4 color, vec4 original) { return vec4(display_color(straight(color.rgb, min(original.a, 1.0))), original.a); }
