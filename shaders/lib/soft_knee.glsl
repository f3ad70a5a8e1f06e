// SPDX-License-Identifier: MIT
#include "lib/color.glsl"

/// Bloom's threshold with a quadratic knee (Catlike Coding, Custom SRP 11: "Bloom"; the curve is Unity's):
///   T(c) = c · max(s, b − t)/max(b, 1e-5),  s = clamp(b − t + tk, 0, 2tk)² · 0.25/(tk + 1e-5),  b = brightest channel.
/// `knee` = (t, tk − t, 2tk, 0.25/(tk + 1e-5)), linear; made once on the host. It is the weight that is divided, not the colour
/// multiplied first, and s · (s · w) instead of s² · w: nothing overflows for any finite input.
vec3 soft_knee_threshold(vec3 c, vec4 knee) {
  float b = brightest(c);
  float s = clamp(b + knee.y, 0.0, knee.z);
  precise float share = s * knee.w;  // in this order, whatever a driver would rather do first
  precise float contribution = max(s * share, b - knee.x);
  precise float weight = contribution / max(b, 1e-5);
  return c * weight;
}

/// The colour as if its brightest channel were at most `most`.
vec3 held_light(vec3 c, float most) { return c * min(1.0, most / max(brightest(c), 1e-5)); }
