// SPDX-License-Identifier: MIT
// The joined picture with the alpha of this frame.
vec4 apply(vec4 color, vec4 picture) { return vec4(color.rgb, picture.a); }
