// SPDX-License-Identifier: MIT
// picture + tint · glow. Alpha of the picture.
#include "lib/color.glsl"

uniform vec3 tint;

vec4 apply(vec4 color, vec4 picture) { return vec4(min(picture.rgb + tint * color.rgb, vec3(kMaxLight)), picture.a); }
