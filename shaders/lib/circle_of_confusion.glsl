// SPDX-License-Identifier: MIT
// Circles of confusion: how wide a lens draws a point that is not in its focus.
/// Radius of the circle of confusion of what lies at distance z, in pixels: below 0 in front of the focus, above 0 behind it. `focus` is its
/// distance, the radius for what is infinitely far, and the widest radius.
float circle_of(float z, vec3 focus) { return clamp(focus.y * (z - focus.x) / max(z, 1e-6), -focus.z, focus.z); }
