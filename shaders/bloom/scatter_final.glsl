// SPDX-License-Identifier: MIT
// lerp(high, color + (high − T(high)), amount), written so that it is `high` to the last bit where nothing blooms: what is spread is only the light that passed the threshold T, so the light that T took
// away is given back and a picture of one colour stays as it is (Catlike Coding, Custom SRP 12: "Scattering Threshold").
#include "lib/soft_knee.glsl"

uniform float amount;
uniform vec4 knee;
uniform float most;

vec4 apply(vec4 color, vec4 high) {
  vec3 spread = soft_knee_threshold(held_light(high.rgb, most), knee);
  return vec4(high.rgb + amount * (color.rgb - spread), high.a);
}
