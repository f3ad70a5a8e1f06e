// SPDX-License-Identifier: MIT
// Piecewise power curves (J. Hable, "Filmic Tonemapping with Piecewise Power Curves", 2017): a toe, a line, a shoulder. The numbers of the three
// are made by the effect; x is light over white.
#include "lib/near_one.glsl"

uniform float inverse_white;
uniform vec2 joints;     // x where the toe ends, x where the shoulder begins
uniform vec2 toe;        // y at its end, power
uniform vec2 line;       // slope, y at x = 0
uniform vec4 shoulder;   // x of its end, y where it begins, height, power
uniform float scale;     // so that white is 1

vec4 apply(vec4 color) {
  vec3 x = clamp(color.rgb, 0.0, 65504.0) * inverse_white;
  vec3 low = toe.x * pow(x / max(joints.x, 1e-9), vec3(toe.y));
  vec3 middle = line.x * x + line.y;
  vec3 way = clamp((x - joints.y) / (shoulder.x - joints.y), 0.0, 1.0);  // of the shoulder
  vec3 high = shoulder.y + shoulder.z * one_minus_exp(shoulder.w * log_of_one_plus(-way));
  vec3 y = mix(mix(high, middle, lessThan(x, vec3(joints.y))), low, lessThan(x, vec3(joints.x)));
  return vec4(y * scale, color.a);
}
