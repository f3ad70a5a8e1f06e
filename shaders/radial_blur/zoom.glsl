// SPDX-License-Identifier: MIT
// Mean of `samples` reads from the pixel (first) to `amount` of its way to the centre (last).
uniform sampler2D source;
uniform float amount;
uniform int samples;  // ≥ 2
uniform vec2 center;  // 0…1

vec4 sample_at(ivec2 pixel) {
  vec2 here = vec2(pixel) + 0.5;
  vec2 way = (center * vec2(target_size()) - here) * amount;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < samples; ++i) sum += fetch_linear(source, here + (float(i) / float(samples - 1)) * way).rgb;
  return vec4(sum / float(samples), fetch(source, pixel).a);
}
