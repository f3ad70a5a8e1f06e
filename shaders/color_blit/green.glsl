// SPDX-License-Identifier: MIT
// Green light alone, scaled: c · (0, intensity, 0, 1).
uniform float intensity;

vec4 apply(vec4 color) { return vec4(0.0, min(intensity * color.g, 1e30), 0.0, color.a); }
