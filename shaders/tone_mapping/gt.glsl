// SPDX-License-Identifier: MIT
// H. Uchimura, "HDR theory and practice" (CEDEC 2017), the curve of Gran Turismo SPORT with its published numbers: a toe, a straight line
// from m to m + l₀ that leaves light as it is, an exponential shoulder towards P = 1.
vec4 apply(vec4 color) {
  const float kStart = 0.22, kLength = 0.4, kTight = 1.33;  // m, l, c; contrast a = 1, pedestal b = 0
  const float kEnd = kStart + (1.0 - kStart) * kLength;     // S0 = S1
  const float kFall = 1.0 / (1.0 - kEnd);                   // C2/P
  vec3 x = clamp(color.rgb, 0.0, 65504.0);
  vec3 toe = kStart * pow(x / kStart, vec3(kTight));
  vec3 t = clamp(x / kStart, 0.0, 1.0);
  vec3 w = t * t * (3.0 - 2.0 * t);
  vec3 low = toe * (1.0 - w) + x * w;
  vec3 high = 1.0 - (1.0 - kEnd) * exp(-kFall * max(x - kEnd, 0.0));
  return vec4(mix(low, high, greaterThanEqual(x, vec3(kEnd))), color.a);
}
