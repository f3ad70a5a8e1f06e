#include "lib/color.glsl"  // kMaxLight

uniform float strength;
uniform vec3 tint;

// Colours carry their alpha: a tint is as strong as the pixel is opaque. Nothing gets brighter than a picture may be.
vec4 apply(vec4 color) {
  return vec4(mix(color.rgb, min(tint * color.a, kMaxLight), strength), color.a);
}
