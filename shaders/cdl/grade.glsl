// SPDX-License-Identifier: MIT
// An ASC CDL of the effect's settings.
#include "lib/cdl.glsl"

layout(constant_id = 0) const bool use_power = true;

uniform vec3 slope;
uniform vec3 offset;
uniform vec3 power;
uniform float saturation;

vec4 apply(vec4 color) { return vec4(cdl_graded(color.rgb, slope, offset, power, saturation, use_power), color.a); }
