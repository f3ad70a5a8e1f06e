// SPDX-License-Identifier: MIT
// Filmic: the fitted ACES transform. Inputs are held to 0…60 as in all tone curves here.
#include "lib/aces.glsl"

vec4 apply(vec4 color) { return vec4(aces_tone_curve(clamp(color.rgb, 0.0, 60.0)), color.a); }
