// SPDX-License-Identifier: MIT
// Codes that a display gets, to light: the inverse of the sRGB curve that outputs encode with.
#include "lib/encoding.glsl"

vec4 apply(vec4 color) { return vec4(linear_from_srgb(color.rgb), color.a); }
