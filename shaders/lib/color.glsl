// SPDX-License-Identifier: MIT
// What several effects need to know about light. Colours are scene-linear Rec.709.

/// The largest value an effect returns. The source of a stack is at most this; keeping to it, sums and products of two colours'
/// channels with everyday factors stay finite in 32 bits from effect to effect.
const float kMaxLight = 1e30;

/// Rec.709/D65 luminance (IEC 61966-2-1; digits as in Unity's Color.hlsl).
float luminance(vec3 c) { return dot(c, vec3(0.2126729, 0.7151522, 0.0721750)); }

/// Brightness as the largest channel: a saturated light counts as much as a white one.
float brightest(vec3 c) { return max(c.r, max(c.g, c.b)); }

/// Exact at both ends and without the cancellation of a + t(b − a).
vec3 lerp(vec3 a, vec3 b, float t) { return a * (1.0 - t) + b * t; }

/// Brightness as the eye counts it, 0…1: the square root of luminance (gamma 2). Light above 1 counts as 1.
float perceived(vec3 c) { return sqrt(luminance(clamp(c, 0.0, 1.0))); }
