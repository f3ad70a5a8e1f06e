// SPDX-License-Identifier: MIT
// How blurred something is.
/// How blurred a circle of this radius (pixels of the picture) is for the eye, 0…1: from half a pixel on, and wholly from what the small
/// picture blurs by itself, whose pixels are `factor` wide.
float blurred(float radius, float factor) { return clamp((abs(radius) - 0.5) / (1.15 * factor - 0.5), 0.0, 1.0); }
