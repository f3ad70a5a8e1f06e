// SPDX-License-Identifier: MIT
// Mean of the histogram without its ends: the exposure value that the picture asks for.
#include "lib/exposure.glsl"

uniform sampler2D rows;
uniform vec2 percentiles;  // 0…1
uniform vec2 limits;       // EV

// Weight and weight·EV of two bins.
vec4 bins_of(int texel) {
  vec4 sum = vec4(0.0);
  int height = image_size(rows).y;
  for (int y = 0; y < height; ++y) sum += fetch(rows, ivec2(texel, y));
  return sum;
}

vec4 sample_at(ivec2 pixel) {
  vec4 bins[kBins / 2];
  float total = 0.0;
  for (int i = 0; i < kBins / 2; ++i) {
    bins[i] = bins_of(i);
    total += bins[i].x + bins[i].z;
  }
  Percentiles p = between(percentiles, total);
  for (int i = 0; i < kBins; ++i) add_bin(p, i % 2 == 0 ? bins[i / 2].xy : bins[i / 2].zw);
  return vec4(mean_of(p, limits), 0.0, 0.0, 1.0);
}
