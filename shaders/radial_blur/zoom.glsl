// SPDX-License-Identifier: MIT
// Mean of `count` reads on the way to the centre, each `ratio` times as far from it as the one before, weighted by how far.
uniform sampler2D source;
uniform vec2 center;  // 0…1
uniform float first;  // distance of the first read, as a share of the pixel's own
uniform float ratio;
uniform int count;

vec4 sample_at(ivec2 pixel) {
  vec2 here = vec2(pixel) + 0.5, way = center * vec2(target_size()) - here;
  vec3 sum = vec3(0.0);
  float weights = 0.0, weight = 1.0;
  for (int i = 0; i < count; ++i) {
    sum += weight * fetch_linear(source, here + (1.0 - first * weight) * way).rgb;
    weights += weight;
    weight *= ratio;
  }
  return vec4(sum / weights, 1.0);
}
