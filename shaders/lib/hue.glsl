// SPDX-License-Identifier: MIT
// Turning hues in HSV, rounding as little as 32 bits allow.
//
// The definition goes colour → (H, S, V) → H + shift → colour, with an ε in both divisions (S. Hocevar's RGB to HSV, as in Unity's
// Color.hlsl, where it is 1e-4). Through H ∈ 0…1 a dark channel of a bright colour loses its digits. Here hue stays what it is: a whole
// sextant n and the position f within it; the shift comes split the same way, and V(1 − S) is V(min + ε)/(V + ε) instead of a difference.

/// As Unity has it. Colours near its size lose hue and saturation, and where two channels are equal, a hue jumps by ε/(3·(max − min)) sextants.
const float kUnityHueEpsilon = 1e-4;
/// HSV itself: hues and saturations are the same whatever the exposure, and no colour jumps. It only keeps greys and black from 0/0.
const float kNoHueEpsilon = 1e-30;

/// `sextants` + `part` = shift/60°, sextants a whole number in −3…3, part in −½…½. c ≥ 0.
vec3 turn_hue(vec3 c, float sextants, float part, float epsilon) {
  bool green_first = c.g >= c.b, red_first;
  float a = green_first ? c.g : c.b, b = green_first ? c.b : c.g;
  red_first = c.r >= a;
  float value = red_first ? c.r : a, other = red_first ? a : c.r;
  float least = min(other, b), d = value - least;

  // 6H = 0 + f, 2 − f, 4 + f or 6 − f
  float f = 6.0 * (other - b) / (6.0 * d + epsilon);
  float n = (red_first ? 0.0 : green_first ? 2.0 : 4.0) + sextants;
  float g = (red_first == green_first ? f : -f) + part;

  // A channel is full within one sextant of its own hue (red 0, green 2, blue 4) and empty from two on: clamp(2 − |m + g|, 0, 1) for m
  // its whole distance in −3…2. |g| ≤ 1.5, so the sign of m + g is m's wherever the clamp does not decide, and m = ±3 sees both sides.
  vec3 m = n - vec3(0.0, 2.0, 4.0);
  m -= 6.0 * floor((m + 3.0) * (1.0 / 6.0));
  vec3 distance_part = mix(-sign(m) * g, vec3(-abs(g)), equal(m, vec3(0.0)));
  distance_part = mix(distance_part, vec3(abs(g)), equal(m, vec3(-3.0)));
  vec3 fullness = clamp((2.0 - abs(m)) + distance_part, 0.0, 1.0);

  float scale = value / (value + epsilon);
  return scale * (least + epsilon) + (scale * d) * fullness;
}

/// HSV's hue and saturation: x its largest channel in sextants (0 red, 2 green, 4 blue), y how far it is from there,
/// −1…1, z the saturation, 0…1. Apart, so that a dark channel of a bright colour keeps its digits. c ≥ 0.
vec3 hue_and_saturation(vec3 c, float epsilon) {
  bool green_first = c.g >= c.b;
  float a = green_first ? c.g : c.b, b = green_first ? c.b : c.g;
  bool red_first = c.r >= a;
  float value = red_first ? c.r : a, other = red_first ? a : c.r;
  float d = value - min(other, b);
  float f = 6.0 * (other - b) / (6.0 * d + epsilon);
  return vec3(red_first ? 0.0 : green_first ? 2.0 : 4.0, red_first == green_first ? f : -f, d / (value + epsilon));
}
