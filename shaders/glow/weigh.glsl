// SPDX-License-Identifier: MIT
// The coarsest level by its weight.
uniform vec3 weight;

vec4 apply(vec4 color) { return vec4(weight * color.rgb, 1.0); }
