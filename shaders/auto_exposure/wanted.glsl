// Mean of the histogram without its ends: the exposure value that the picture asks for.
#include "lib/exposure.glsl"

uniform sampler2D rows;
uniform vec2 percentiles;  // 0…1
uniform vec2 limits;       // EV

vec4 bins_of(int texel) {
  vec4 sum = vec4(0.0);
  int height = image_size(rows).y;
  for (int y = 0; y < height; ++y) sum += fetch(rows, ivec2(texel, y));
  return sum;
}

vec4 sample_at(ivec2 pixel) {
  vec4 bins[kBins / 4];
  float total = 0.0;
  for (int i = 0; i < kBins / 4; ++i) {
    bins[i] = bins_of(i);
    total += dot(bins[i], vec4(1.0));
  }
  float skip = total * percentiles.x, rest = total * (percentiles.y - percentiles.x), sum = 0.0, count = 0.0;
  for (int i = 0; i < kBins; ++i) {
    float bin = bins[i / 4][i % 4];
    float dark = min(bin, skip);
    skip -= dark;
    float counted = min(bin - dark, rest);
    rest -= counted;
    sum += counted * ev_of_bin(i);
    count += counted;
  }
  return vec4(clamp(sum / max(count, 1e-20), limits.x, limits.y), 0.0, 0.0, 1.0);
}
