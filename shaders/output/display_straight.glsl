// The last step to an 8-bit display file with transparency: colours are divided by the alpha of the original picture, which no effect
// changes, in linear light; where it is 0 they stay undivided.
#include "lib/display.glsl"

layout(constant_id = 0) const bool dither = false;

vec4 apply(vec4 color, vec4 original, ivec2 pixel) {
  float a = original.a;
  vec3 light = a > 0.0 ? color.rgb / a : color.rgb;
  return vec4(display_color(light, dither, pixel), a);
}
