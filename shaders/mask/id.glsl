// SPDX-License-Identifier: MIT
// Where the first channel of a layer is a number.
uniform float index;

vec4 apply(vec4 color, vec4 layer) { return vec4(abs(layer.r - index) < 0.5 ? 1.0 : 0.0); }
