// SPDX-License-Identifier: MIT
// Mean over 2×2 pixels, which together have read every texel. It lies half a pixel further right and down.
uniform sampler2D source;

vec4 sample_at(ivec2 pixel) {
  return 0.25 * (fetch(source, pixel) + fetch(source, pixel + ivec2(1, 0)) + fetch(source, pixel + ivec2(0, 1)) + fetch(source, pixel + 1));
}
