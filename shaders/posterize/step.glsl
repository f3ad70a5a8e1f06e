// SPDX-License-Identifier: MIT
// Scales a colour so that the square root of its luminance lies on one of the steps, or on the slope between two.
#include "lib/color.glsl"

uniform float steps, soft, share;
uniform float kept;  // up to this, what is darker than the first tone stays as it is

vec4 apply(vec4 color) {
  float eye = sqrt(max(luminance(color.rgb), 0.0));
  float at = min(eye, 1.0) * steps;
  float below = floor(at);
  float slope = clamp((at - below - 0.5) / soft + 0.5, 0.0, 1.0);  // a step lies half way between two tones
  float tone = mix(below > 0.0 ? below / steps : min(eye, kept), (below + 1.0) / steps, slope);
  float scale = eye > 1.0 ? 1.0 : tone / max(eye, 1e-6);
  scale = min(scale * scale, max(1.0, 1.0 / max(brightest(color.rgb), 1e-6)));  // no channel is driven above white
  return vec4(lerp(color.rgb, color.rgb * scale, share), color.a);
}
