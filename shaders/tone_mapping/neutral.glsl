// SPDX-License-Identifier: MIT
// Unity's neutral curve: Hable's N(x) = (x(ax + cb) + de)/(x(ax + b) + df) − e/f with a=0.2 b=0.29 c=0.24 d=0.272 e=0.02 f=0.3, as k·N(kx)
// with k = 1/N(5.3), so that 5.3/k = 4.035 is white. Over one denominator N loses its constant term,
//   N(x) = x(a(f − e)x + b(cf − e)) / (f(x(ax + b) + df)),
// which is exact at 0, where the difference above cancels; then k is multiplied out and the fraction divided by f·a·k².
vec4 apply(vec4 color) {
  vec3 x = clamp(color.rgb, 0.0, 60.0);
  vec3 y = x * (1.2258270597544778 * x + 0.25133333333333333) / (x * (x + 1.1040165270983608) + 0.23652405078686378);
  return vec4(y, color.a);
}
