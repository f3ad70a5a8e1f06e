// SPDX-License-Identifier: MIT
// What colours are divided by where straight ones are wanted, and multiplied by behind that (math.md §19).

/// Below it, the smallest normal float, there is no coverage: devices differ in whether they take such numbers for 0.
const float kLeastAlpha = 1.17549435e-38;

/// The divisor for an alpha. At most 65504, so that what is multiplied again stays finite.
float cover_of(float alpha) { return alpha >= kLeastAlpha ? min(alpha, 65504.0) : 1.0; }

/// Light without its coverage; where there is none, as it is.
vec3 straight(vec3 light, float alpha) { return light / cover_of(alpha); }
vec3 straight(vec4 color) { return straight(color.rgb, color.a); }
