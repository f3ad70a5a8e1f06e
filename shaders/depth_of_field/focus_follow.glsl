// SPDX-License-Identifier: MIT
// From the focus of the frame before towards the wanted one. Exact for any time, so that two short steps are one long one.
uniform float left;  // of the way, after this frame: exp(−speed·seconds)

vec4 apply(vec4 color, vec4 before) { return vec4(color.r + (before.r - color.r) * left, 0.0, 0.0, 1.0); }
