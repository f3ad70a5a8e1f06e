// SPDX-License-Identifier: MIT
vec4 apply(vec4 color) { return color; }
