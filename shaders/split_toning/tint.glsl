// SPDX-License-Identifier: MIT
// Soft light with two tints, shared out by luminance; in gamma 2.2 (Unity's LutBuilder: "Split toning").
#include "lib/color.glsl"

uniform vec3 shadows;     // 1 − 2·display value: 1 darkens most, 0 is neutral, −1 lightens most
uniform vec3 highlights;
uniform float balance;    // −1…1

/// Unity's soft light (Color.hlsl): darkens by a parabola, lightens by a root. `amount` is 1 − 2·blend, which near the neutral grey has
/// digits that the blend has not. White stays, and so does what is brighter: the formula beyond it would turn tints round.
vec3 soft_light(vec3 bright, vec3 amount) {
  vec3 over = max(bright, 1.0), base = bright / over;
  vec3 dark = base * ((1.0 - amount) + base * amount);
  vec3 light = base * (1.0 + amount) - sqrt(base) * amount;
  return mix(dark, light, lessThanEqual(amount, vec3(0.0))) * over;
}

vec4 apply(vec4 color) {
  vec3 c = pow(max(color.rgb, 0.0), vec3(1.0 / 2.2));
  float bright = clamp(1.0 - luminance(1.0 - min(c, 1.0)) + balance, 0.0, 1.0);  // 1 for white, to the last digit
  c = soft_light(c, shadows * (1.0 - bright));
  c = soft_light(c, highlights * bright);
  return vec4(min(pow(c, vec3(2.2)), kMaxLight), color.a);
}
