// SPDX-License-Identifier: MIT
// Lays a small image over the picture, with its upper left corner at `corner`. Its light is seen where the picture is empty, too.
#include "lib/color.glsl"

uniform sampler2D label;
uniform ivec2 corner;

vec4 apply(vec4 color, ivec2 pixel) {
  ivec2 at = pixel - corner;
  bool beside = any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, image_size(label)));
  if (beside) return color;
  vec4 over = fetch(label, at);
  return vec4(over.rgb + color.rgb * (1.0 - over.a), color.a);
}
