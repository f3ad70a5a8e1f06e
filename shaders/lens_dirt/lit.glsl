// SPDX-License-Identifier: MIT
// What the dirt makes of the light behind it. Alpha counts for nothing.
vec4 apply(vec4 color, vec4 dirt) { return dirt.r * color; }
