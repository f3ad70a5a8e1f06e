// SPDX-License-Identifier: MIT
// Khronos PBR Neutral (E. Chiu, B. Hearne et al., 2024): colours below 0.8 keep what a material's base colour was, minus the 4 % that a
// dielectric reflects; above, the peak is compressed and moves towards white.
vec4 apply(vec4 color) {
  const float kStart = 0.8 - 0.04, kDesaturation = 0.15, kRoom = 1.0 - kStart;
  vec3 c = clamp(color.rgb, 0.0, 65504.0);
  float x = min(c.r, min(c.g, c.b));
  // c − (x − 6.25x²) below 0.08, as a sum of two numbers that are not negative.
  c = x < 0.08 ? (c - x) + 6.25 * x * x : c - 0.04;
  float peak = max(c.r, max(c.g, c.b));
  float above = max(peak - kStart, 0.0);
  float held = 1.0 - kRoom * kRoom / (above + kRoom);
  float keep = 1.0 / (kDesaturation * (peak - held) + 1.0);
  vec3 bright = (c * (held / max(peak, kStart))) * keep + held * (1.0 - keep);
  return vec4(peak < kStart ? c : bright, color.a);
}
