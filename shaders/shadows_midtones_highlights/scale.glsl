// c·(S·s + M·m + H·h): s, m, h add up to 1 and come from luminance (Unity's LutBuilder: "Shadows, midtones, highlights").
#include "lib/color.glsl"

uniform vec3 shadows;
uniform vec3 midtones;
uniform vec3 highlights;
uniform vec2 shadow_limits;     // luminance: from 1 to 0 between these
uniform vec2 highlight_limits;  // luminance: from 0 to 1 between these

vec4 apply(vec4 color) {
  float y = luminance(color.rgb);
  float s = 1.0 - smoothstep(shadow_limits.x, shadow_limits.y, y);
  float h = smoothstep(highlight_limits.x, highlight_limits.y, y);
  float m = 1.0 - s - h;  // below 0 where the limits overlap
  return vec4(clamp(color.rgb * (shadows * s + midtones * m + highlights * h), 0.0, kMaxLight), color.a);
}
