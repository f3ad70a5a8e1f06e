// SPDX-License-Identifier: MIT
// Reads at t = 0…1 of the way from the pixel to its end point, weighted red 1 − 2t, green 1 − |2t − 1|, blue 2t − 1.
uniform sampler2D source;
uniform float amount;  // length of the way in pictures, at the middle of a side
uniform int samples;   // ≥ 3

vec4 sample_at(ivec2 pixel) {
  vec2 size = vec2(target_size());
  vec2 from_centre = (vec2(2 * pixel + 1) - size) / size;  // −1…1
  vec2 way = -from_centre * dot(from_centre, from_centre) * amount * size;
  vec3 sum = vec3(0.0), weights = vec3(0.0);
  for (int i = 0; i < samples; ++i) {
    float t = float(i) / float(samples - 1);
    vec3 weight = clamp(vec3(1.0 - 2.0 * t, 1.0 - abs(2.0 * t - 1.0), 2.0 * t - 1.0), 0.0, 1.0);
    sum += weight * fetch_linear(source, (vec2(pixel) + 0.5) + t * way).rgb;
    weights += weight;
  }
  return vec4(sum / weights, fetch(source, pixel).a);
}
