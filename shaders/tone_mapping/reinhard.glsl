// SPDX-License-Identifier: MIT
// x/(1 + x) per channel (Reinhard et al. 2002, without the white point). Inputs are held to 0…60 as in all tone curves here.
vec4 apply(vec4 color) {
  vec3 x = clamp(color.rgb, 0.0, 60.0);
  return vec4(x / (1.0 + x), color.a);
}
