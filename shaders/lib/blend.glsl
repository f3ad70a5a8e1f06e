// SPDX-License-Identifier: MIT
// An entry's result over what it was given (math.md §20). Modes are numbers in the order of the documents.
#include "lib/alpha.glsl"
#include "lib/color.glsl"

const int kBlendNormal = 0, kBlendAdd = 1, kBlendScreen = 2, kBlendMultiply = 3, kBlendOverlay = 4, kBlendSoftLight = 5, kBlendLighten = 6,
          kBlendDarken = 7, kBlendHardLight = 8, kBlendColor = 9, kBlendLuminosity = 10;

// a + b − ab, where both are within 0…1; beyond, the larger one (as Nuke's Merge has it): at 1 both are the same.
vec3 blend_screen(vec3 a, vec3 b) {
  vec3 sum = a * (1.0 - b) + b;
  return mix(sum, max(a, b), greaterThan(max(a, b), vec3(1.0)));
}

// W3C Compositing 1: hard light of `a` on `b` with the two changed over. Of encoded values.
vec3 blend_overlay(vec3 below, vec3 above) {
  return mix(blend_screen(2.0 * below - 1.0, above), 2.0 * below * above, lessThanEqual(below, vec3(0.5)));
}

// W3C Compositing 1, of encoded values. What is above white below stays as it is; above white above counts as white.
vec3 blend_soft_light(vec3 below, vec3 above) {
  vec3 s = clamp(above, 0.0, 1.0), b = clamp(below, 0.0, 1.0);
  vec3 dark = below - (1.0 - 2.0 * s) * b * (1.0 - b);
  vec3 curve = mix(sqrt(b), ((16.0 * b - 12.0) * b + 4.0) * b, lessThanEqual(b, vec3(0.25)));
  vec3 light = below + (2.0 * s - 1.0) * (curve - b);
  return mix(light, dark, lessThanEqual(s, vec3(0.5)));
}

// The colour of `above` at the luminance of `below`, by a factor, so that light beyond 1 keeps its colour too. What is black has none: it goes to grey.
vec3 blend_color(vec3 below, vec3 above) {
  vec3 light = max(above, 0.0) + 1e-4;
  return light * (luminance(max(below, 0.0)) / luminance(light));
}

// Straight colours; scene-linear, but for overlay, hard_light and soft_light, whose middle is that of encoded values (gamma 2.2).
vec3 blended(vec3 below, vec3 above, int mode) {
  if (mode == kBlendAdd) return below + above;
  if (mode == kBlendScreen) return blend_screen(max(below, 0.0), max(above, 0.0));
  if (mode == kBlendMultiply) return below * above;
  if (mode == kBlendLighten) return max(below, above);
  if (mode == kBlendDarken) return min(below, above);
  if (mode == kBlendColor) return blend_color(below, above);
  if (mode == kBlendLuminosity) return blend_color(above, below);
  if (mode == kBlendOverlay || mode == kBlendHardLight || mode == kBlendSoftLight) {
    vec3 b = pow(max(below, 0.0), vec3(1.0 / 2.2)), a = pow(max(above, 0.0), vec3(1.0 / 2.2));
    vec3 made = mode == kBlendOverlay ? blend_overlay(b, a) : mode == kBlendHardLight ? blend_overlay(a, b) : blend_soft_light(b, a);
    return pow(max(made, 0.0), vec3(2.2));
  }
  return above;
}

// From what is below to the blend by `share`. Both have the alpha of what is below.
vec4 composite(vec4 above, vec4 below, float share, int mode) {
  float cover = cover_of(below.a);
  bool by_straight = mode == kBlendScreen || mode == kBlendMultiply || mode == kBlendOverlay || mode == kBlendSoftLight || mode == kBlendHardLight ||
                     mode == kBlendColor || mode == kBlendLuminosity;
  vec3 c = by_straight ? blended(below.rgb / cover, above.rgb / cover, mode) * cover : blended(below.rgb, above.rgb, mode);
  c = clamp(lerp(below.rgb, min(c, kMaxLight), share), -kMaxLight, kMaxLight);
  return vec4(c, below.a);
}
