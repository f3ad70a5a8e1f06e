// SPDX-License-Identifier: MIT
#include "lib/color.glsl"

uniform sampler2D adapted;  // one texel: the exposure value that is middle grey
uniform float compensation;

vec4 apply(vec4 color) { return vec4(min(color.rgb * exp2(compensation - fetch(adapted, ivec2(0)).r), kMaxLight), color.a); }
