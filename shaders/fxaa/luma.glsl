// SPDX-License-Identifier: MIT
// Perceptual brightness.
#include "lib/color.glsl"

vec4 apply(vec4 color) { return vec4(perceived(color.rgb)); }
