// SPDX-License-Identifier: MIT
// Mean over a spiral of whole pixels, as wide as any circle around. Points get sparser outwards and weigh more, so that small circles have
// their share of reads.
uniform sampler2D source;   // radius of the circle of confusion as alpha
uniform sampler2D picture;
uniform sampler2D widest;   // circle around, by tile
uniform int block;
uniform float max_radius;
uniform int samples;

const mat2 kGoldenAngle = mat2(-0.73736888, -0.67549029, 0.67549029, -0.73736888);

vec4 sample_at(ivec2 pixel) {
  vec4 own = fetch(source, pixel);
  float around = fetch(widest, pixel / block).a;
  if (around < 0.5) return vec4(own.rgb, fetch(picture, pixel).a);  // nothing is wider than a pixel
  float limit = min(around + 0.5, max_radius);
  float weight = 0.5 / float(samples);
  vec3 mean = own.rgb;
  vec2 direction = vec2(1.0, 0.0);
  for (int i = 0; i < samples; ++i) {
    float t = (float(i) + 0.5) / float(samples), radius = t * limit;
    direction = kGoldenAngle * direction;
    vec4 read = fetch(source, pixel + ivec2(floor(direction * radius + 0.5)));
    float reach = abs(read.a);
    if (read.a > own.a) reach = min(reach, 2.0 * abs(own.a));
    weight += t;
    // A read whose circle does not reach the pixel counts as the mean so far.
    mean += (t / weight) * smoothstep(radius - 0.5, radius + 0.5, reach) * (read.rgb - mean);
  }
  return vec4(mean, fetch(picture, pixel).a);
}
