// SPDX-License-Identifier: MIT
// The mean of what was weighed. Alpha of the picture.
vec4 apply(vec4 color, vec4 picture) { return vec4(color.rgb / color.a, picture.a); }
