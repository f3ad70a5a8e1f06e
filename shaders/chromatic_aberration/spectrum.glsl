// SPDX-License-Identifier: MIT
// Reads at t = 0…1 of the way from the pixel to its end point, weighted red 1 − 2t, green 1 − |2t − 1|, blue 2t − 1: as many as the way has
// pixels, so that no read shows by itself.
uniform sampler2D source;
uniform float amount;  // length of the way in pictures, at the middle of a side
uniform int samples;   // ≥ 3; 3: no more than that

vec4 sample_at(ivec2 pixel) {
  vec2 size = vec2(target_size());
  vec2 from_centre = (vec2(2 * pixel + 1) - size) / size;  // −1…1
  vec2 way = -from_centre * dot(from_centre, from_centre) * amount * size;
  float reach = length(way);
  // In wholes from a fraction that is no rounded number: 0.3 of a pixel more than a whole one takes one more.
  int steps = samples == 3 ? 2 : max(max(2, int(floor(reach * (2.0 / 3.0) + 0.7))), min(samples - 1, int(floor(reach + 0.7))));
  float step = 1.0 / float(steps);
  vec3 sum = vec3(0.0), weights = vec3(0.0);
  for (int i = 0; i <= steps; ++i) {
    float t = float(i) * step, u = 2.0 * t - 1.0;
    vec3 weight = vec3(max(-u, 0.0), 1.0 - abs(u), max(u, 0.0));
    sum += weight * fetch_linear(source, (vec2(pixel) + 0.5) + t * way).rgb;
    weights += weight;
  }
  return vec4(sum / weights, fetch(source, pixel).a);
}
