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
  float skip = total * percentiles.x, rest = total * (percentiles.y - percentiles.x), sum = 0.0, count = 0.0;
  for (int i = 0; i < kBins; ++i) {
    vec2 bin = i % 2 == 0 ? bins[i / 2].xy : bins[i / 2].zw;
    float dark = min(bin.x, skip);
    skip -= dark;
    float counted = min(bin.x - dark, rest);
    rest -= counted;
    if (counted > 0.0) sum += counted * (bin.y / bin.x);
    count += counted;
  }
  return vec4(clamp(sum / max(count, 1e-20), limits.x, limits.y), 0.0, 0.0, 1.0);
}
