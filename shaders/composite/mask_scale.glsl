// SPDX-License-Identifier: MIT
// A mask and numbers: factor · mask + offset.
uniform float factor;
uniform float offset;

vec4 apply(vec4 color) { return clamp(clamp(color, 0.0, 1.0) * factor + offset, 0.0, 1.0); }
