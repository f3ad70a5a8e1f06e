// SPDX-License-Identifier: MIT
// An entry's result over what it was given, as far as its mask says.
#include "lib/blend.glsl"

layout(constant_id = 0) const int mode = 0;
uniform float opacity;

vec4 apply(vec4 color, vec4 below, vec4 mask) { return composite(color, below, opacity * clamp(mask.r, 0.0, 1.0), mode); }
