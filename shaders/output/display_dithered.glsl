// SPDX-License-Identifier: MIT
// The same with blue noise between two codes.
#include "lib/dither.glsl"

uniform sampler2D noise;

vec4 apply(vec4 color, ivec2 pixel) { return vec4(dithered_color(color.rgb, fetch(noise, pixel & 63).r), 1.0); }
