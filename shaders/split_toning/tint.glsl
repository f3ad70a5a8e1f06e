// Soft light with two tints, shared out by luminance; in gamma 2.2 (Unity's LutBuilder: "Split toning").
#include "lib/color.glsl"

uniform vec3 shadows;     // display values 0…1, ½ is neutral
uniform vec3 highlights;
uniform float balance;    // −1…1

/// Unity's soft light (Color.hlsl): darkens by a parabola, lightens by a root.
vec3 soft_light(vec3 base, vec3 blend) {
  vec3 dark = 2.0 * base * blend + base * base * (1.0 - 2.0 * blend);
  vec3 light = sqrt(base) * (2.0 * blend - 1.0) + 2.0 * base * (1.0 - blend);
  return min(mix(dark, light, greaterThanEqual(blend, vec3(0.5))), 1e15);
}

vec4 apply(vec4 color) {
  vec3 c = pow(max(color.rgb, 0.0), vec3(1.0 / 2.2));
  float bright = clamp(luminance(min(c, 1.0)) + balance, 0.0, 1.0);
  c = soft_light(c, lerp(shadows, vec3(0.5), bright));
  c = soft_light(c, lerp(vec3(0.5), highlights, bright));
  return vec4(min(pow(c, vec3(2.2)), kMaxLight), color.a);
}
