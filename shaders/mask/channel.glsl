// SPDX-License-Identifier: MIT
// One channel of a layer, or its luminance.
#include "lib/color.glsl"

layout(constant_id = 0) const int channel = 0;  // 0…3, 4: luminance

vec4 apply(vec4 color, vec4 layer) {
  float value = channel == 0 ? layer.r : channel == 1 ? layer.g : channel == 2 ? layer.b : layer.a;
  return vec4(channel == 4 ? luminance(layer.rgb) : value);
}
