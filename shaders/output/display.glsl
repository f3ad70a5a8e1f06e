// The last step to an 8-bit display file without transparency.
#include "lib/display.glsl"

layout(constant_id = 0) const bool dither = false;

vec4 apply(vec4 color, ivec2 pixel) { return vec4(display_color(color.rgb, dither, pixel), 1.0); }
