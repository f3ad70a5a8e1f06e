// SPDX-License-Identifier: MIT
// Perceptual brightness of a pixel, in red.
#include "lib/color.glsl"

vec4 apply(vec4 color) { return vec4(perceived(color.rgb), 0.0, 0.0, 1.0); }
