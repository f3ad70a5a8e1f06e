// SPDX-License-Identifier: MIT
// Two masks: where either is.
vec4 apply(vec4 color, vec4 other) { return clamp(color + other, 0.0, 1.0); }
