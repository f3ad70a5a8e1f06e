// SPDX-License-Identifier: MIT
// An ASC CDL of a file, as g:lookup lays it out: see engine/image/lut_file.h.
#include "lib/cdl.glsl"

uniform sampler2D table;
layout(constant_id = 0) const int row = 0;

vec4 apply(vec4 color) {
  vec3 slope = fetch(table, ivec2(0, row)).rgb, offset = fetch(table, ivec2(1, row)).rgb, power = fetch(table, ivec2(2, row)).rgb;
  return vec4(cdl_graded(color.rgb, slope, offset, power, fetch(table, ivec2(3, row)).x, true), color.a);
}
