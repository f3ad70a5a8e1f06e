// SPDX-License-Identifier: MIT
// One channel of a picture of any size, stretched over this one.
#include "lib/color.glsl"

uniform sampler2D picture;
layout(constant_id = 0) const int channel = 0;  // 0…3, 4: luminance

vec4 sample_at(ivec2 pixel) {
  vec4 c = sample_scaled(picture, pixel, ivec2(0));
  return vec4(channel == 4 ? luminance(c.rgb) : c[min(channel, 3)]);
}
