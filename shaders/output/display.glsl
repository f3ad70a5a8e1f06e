// SPDX-License-Identifier: MIT
// The last step to an 8-bit display file without transparency: the nearest codes.
#include "lib/display.glsl"

vec4 apply(vec4 color) { return vec4(display_color(color.rgb), 1.0); }
