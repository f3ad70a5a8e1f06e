// SPDX-License-Identifier: MIT
// Contrast in Alexa LogC (El 1000), as in Unity's colour adjustments: Lin((LogC(x) − p)·k + p) with the pivot p = 0.4135884, ACEScc's middle
// grey. LogC(x) = c·log10(v) + d with v = 5.555556x + 0.047996, so the whole is a power around the pivot's v₀ = 10^((p − d)/c):
//   x' = (v·(v/v₀)^(k−1) − 0.047996)/5.555556.
// This form rounds only what differs from k = 1, and the exponent is small where it matters, near middle grey.

vec3 log_contrast(vec3 x, float k) {
  const float kScale = 5.555556, kOffset = 0.047996, kPivot = 1.296717024762404;
  // v ≤ 0 stands for black in log space (−∞): it stays 0, but for k = 0, where every colour becomes the pivot's grey.
  vec3 v = max(kScale * x + kOffset, vec3(k == 0.0 ? 1.0 : 0.0));
  vec3 exponent = (k - 1.0) * log2(max(v * (1.0 / kPivot), 1e-37));
  vec3 raised = min(v * exp2(exponent), 1e30);
  return (raised - kOffset) * (1.0 / kScale);
}
