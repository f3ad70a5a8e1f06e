// SPDX-License-Identifier: MIT
// Exposure, contrast, filter, hue and saturation in this order (Unity's colour adjustments). A step that is neutral is not compiled in.
#include "lib/color.glsl"
#include "lib/hue.glsl"
#include "lib/log_contrast.glsl"

layout(constant_id = 0) const bool use_exposure = false;
layout(constant_id = 1) const bool use_contrast = false;
layout(constant_id = 2) const bool use_filter = false;
layout(constant_id = 3) const bool use_hue = false;
layout(constant_id = 4) const bool use_saturation = false;

uniform float exposure;         // 2^EV
uniform float contrast;         // 0…2, 1 is neutral
uniform vec3 filter_color;
uniform float hue_sextants;     // whole sixths of a turn, and what is left over
uniform float hue_part;
uniform float saturation;       // −1…1, 0 is neutral

vec4 apply(vec4 color) {
  vec3 c = min(color.rgb, 60.0);
  if (use_exposure) c *= exposure;
  if (use_contrast) c = log_contrast(c, contrast);
  if (use_filter) c *= filter_color;
  c = clamp(c, 0.0, kMaxLight);  // contrast makes darks negative
  if (use_hue) c = turn_hue(c, hue_sextants, hue_part, kUnityHueEpsilon);
  if (use_saturation) c = clamp(c * (1.0 + saturation) - luminance(c) * saturation, 0.0, kMaxLight);  // a dark channel keeps its digits
  return vec4(c, color.a);
}
