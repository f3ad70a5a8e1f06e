// SPDX-License-Identifier: MIT
// c → lerp(c, decode(steps(encode(c))), intensity): the steps of a look-up table that g:lookup read, one behind the other.
#include "lib/color.glsl"
#include "lib/encoding.glsl"
#include "lib/lut.glsl"

uniform sampler2D table;
uniform float intensity;
layout(constant_id = 0) const int before = 1;  // encodings: see lib/encoding.glsl
layout(constant_id = 1) const int behind = 1;
layout(constant_id = 2) const int kind1 = 0;
layout(constant_id = 3) const int row1 = 0;
layout(constant_id = 4) const int size1 = 0;
layout(constant_id = 5) const int kind2 = 0;
layout(constant_id = 6) const int row2 = 0;
layout(constant_id = 7) const int size2 = 0;
layout(constant_id = 8) const int kind3 = 0;
layout(constant_id = 9) const int row3 = 0;
layout(constant_id = 10) const int size3 = 0;
layout(constant_id = 11) const int kind4 = 0;
layout(constant_id = 12) const int row4 = 0;
layout(constant_id = 13) const int size4 = 0;
layout(constant_id = 14) const int kind5 = 0;
layout(constant_id = 15) const int row5 = 0;
layout(constant_id = 16) const int size5 = 0;
layout(constant_id = 17) const int kind6 = 0;
layout(constant_id = 18) const int row6 = 0;
layout(constant_id = 19) const int size6 = 0;
layout(constant_id = 20) const bool unit = false;  // what the last step gives is 0…1

vec3 matrix_step(vec3 c, int row) {
  vec4 r = fetch(table, ivec2(0, row)), g = fetch(table, ivec2(1, row)), b = fetch(table, ivec2(2, row));
  return vec3(dot(r.rgb, c) + r.a, dot(g.rgb, c) + g.a, dot(b.rgb, c) + b.a);
}

vec3 table_1d(vec3 c, int row, int size) {
  vec3 at = clamp(c, 0.0, 1.0) * float(size - 1);
  ivec3 low = ivec3(at), high = min(low + 1, ivec3(size - 1));
  vec3 t = at - vec3(low);
  vec3 a = vec3(fetch(table, lut_entry(row, low.r)).r, fetch(table, lut_entry(row, low.g)).g, fetch(table, lut_entry(row, low.b)).b);
  vec3 b = vec3(fetch(table, lut_entry(row, high.r)).r, fetch(table, lut_entry(row, high.g)).g, fetch(table, lut_entry(row, high.b)).b);
  return a * (1.0 - t) + b * t;
}

vec3 table_half(vec3 c, int row) {
  ivec3 low = ivec3(0), high = ivec3(0);
  vec3 t = vec3(0.0);
  lut_half(c.r, low.r, high.r, t.r);
  lut_half(c.g, low.g, high.g, t.g);
  lut_half(c.b, low.b, high.b, t.b);
  vec3 a = vec3(fetch(table, lut_entry(row, low.r)).r, fetch(table, lut_entry(row, low.g)).g, fetch(table, lut_entry(row, low.b)).b);
  vec3 b = vec3(fetch(table, lut_entry(row, high.r)).r, fetch(table, lut_entry(row, high.g)).g, fetch(table, lut_entry(row, high.b)).b);
  return a * (1.0 - t) + b * t;
}

vec3 table_3d(vec3 c, int row, int size) {
  vec3 at = clamp(c, 0.0, 1.0) * float(size - 1);
  ivec3 low = min(ivec3(at), ivec3(size - 2));  // white is the far corner of the last cell
  ivec2 step_b = lut_step_b(size, low.b), a, b;
  vec4 weights = lut_tetrahedron(at - vec3(low), step_b, a, b);
  ivec2 entry = lut_entry(row, size, low);
  return fetch(table, entry).rgb * weights.x + fetch(table, entry + a).rgb * weights.y + fetch(table, entry + b).rgb * weights.z +
         fetch(table, entry + 1 + step_b).rgb * weights.w;
}

vec3 table_face(ivec2 entry, vec2 f) {
  vec3 below = fetch(table, entry).rgb * (1.0 - f.r) + fetch(table, entry + ivec2(1, 0)).rgb * f.r;
  vec3 above = fetch(table, entry + ivec2(0, 1)).rgb * (1.0 - f.r) + fetch(table, entry + ivec2(1, 1)).rgb * f.r;
  return below * (1.0 - f.g) + above * f.g;
}

vec3 table_3d_linear(vec3 c, int row, int size) {
  vec3 at = clamp(c, 0.0, 1.0) * float(size - 1);
  ivec3 low = min(ivec3(at), ivec3(size - 2));
  vec3 f = at - vec3(low);
  ivec2 entry = lut_entry(row, size, low);
  return table_face(entry, f.rg) * (1.0 - f.b) + table_face(entry + lut_step_b(size, low.b), f.rg) * f.b;
}

vec3 range_step(vec3 c, int row) {
  vec4 r = fetch(table, ivec2(0, row));
  return clamp(c * r.x + r.y, r.z, r.w);
}

vec3 cdl_step(vec3 c, int row) {
  return lut_cdl(c, fetch(table, ivec2(0, row)).rgb, fetch(table, ivec2(1, row)).rgb, fetch(table, ivec2(2, row)).rgb,
                 fetch(table, ivec2(3, row)).xy);
}

vec3 power_step(vec3 c, int row) {
  vec4 p = fetch(table, ivec2(0, row));
  return lut_power(c, p.rgb, p.a);
}

// The kind is compiled in: of these, one is left.
vec3 one_step(vec3 c, int kind, int row, int size) {
  if (kind == kLutMatrix) return matrix_step(c, row);
  if (kind == kLutTable1d) return table_1d(c, row, size);
  if (kind == kLutTable3d) return table_3d(c, row, size);
  if (kind == kLutTable3dLinear) return table_3d_linear(c, row, size);
  if (kind == kLutRange) return range_step(c, row);
  if (kind == kLutCdl) return cdl_step(c, row);
  if (kind == kLutPower) return power_step(c, row);
  if (kind == kLutTableHalf) return table_half(c, row);
  return c;
}

// Tables know 0…1 alone, and most give no more: there sRGB is a polynomial.
vec3 first_codes(vec3 c) {
  bool held = kind1 == kLutTable1d || kind1 == kLutTable3d || kind1 == kLutTable3dLinear;
  if (held && before == kEncodingSrgb) return srgb_from_linear_unit(clamp(c, 0.0, 1.0));
  return encoded(c, before);
}

vec3 last_light(vec3 c) {
  if (unit && behind == kEncodingSrgb) return linear_from_srgb_unit(c);
  return clamp(decoded(c, behind), -kMaxLight, kMaxLight);
}

vec4 apply(vec4 color) {
  vec3 c = first_codes(color.rgb);
  c = one_step(c, kind1, row1, size1);
  c = one_step(c, kind2, row2, size2);
  c = one_step(c, kind3, row3, size3);
  c = one_step(c, kind4, row4, size4);
  c = one_step(c, kind5, row5, size5);
  c = one_step(c, kind6, row6, size6);
  return vec4(lerp(color.rgb, last_light(c), intensity), color.a);
}
