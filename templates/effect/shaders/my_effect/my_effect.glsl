#include "lib/color.glsl"  // kMaxLight

uniform float strength;
uniform vec3 tint;

// Colours carry their alpha: a tint is as strong as the pixel is opaque. No light beyond what a picture may hold.
vec4 apply(vec4 color) {
  return vec4(mix(color.rgb, clamp(tint * color.a, -kMaxLight, kMaxLight), strength), color.a);
}
