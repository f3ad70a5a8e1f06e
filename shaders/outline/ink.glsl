// SPDX-License-Identifier: MIT
// Draws the lines (their strength is the colour that flows in) over the picture. Alpha of the picture.
#include "lib/color.glsl"

layout(constant_id = 0) const bool add_light = false;  // picture + strength · ink; else a blend from one to the other
uniform vec3 ink;

vec4 apply(vec4 line, vec4 picture) {
  vec3 c = add_light ? min(picture.rgb + line.r * picture.a * ink, kMaxLight) : lerp(picture.rgb, ink * picture.a, line.r);
  return vec4(c, picture.a);
}
