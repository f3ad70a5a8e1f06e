// SPDX-License-Identifier: MIT
// An entry's result over what it was given, everywhere alike.
#include "lib/blend.glsl"

layout(constant_id = 0) const int mode = 0;
uniform float opacity;

vec4 apply(vec4 color, vec4 below) { return composite(color, below, opacity, mode); }
