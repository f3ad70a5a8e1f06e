// SPDX-License-Identifier: MIT
// The light of each pixel above a threshold.
#include "lib/bright.glsl"

uniform float threshold, limit;

vec4 apply(vec4 color) { return vec4(light_above(color.rgb, threshold, limit), 1.0); }
