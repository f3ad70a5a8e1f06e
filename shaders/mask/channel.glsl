// One channel of a layer, or its luminance.
#include "lib/color.glsl"

layout(constant_id = 0) const int channel = 0;  // 0…3, 4: luminance

vec4 apply(vec4 color, vec4 layer) { return vec4(channel == 4 ? luminance(layer.rgb) : layer[channel]); }
