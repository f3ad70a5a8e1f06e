// SPDX-License-Identifier: MIT
// Behind each pass of a frame that is traced (--nan-policy neighbour): what is not finite becomes the mean of the finite values of the
// same channel in the smallest square around it that has one, up to 4 pixels away; 0 where none has.
#include "lib/finite.glsl"

uniform sampler2D source;

vec4 sample_at(ivec2 pixel) {
  vec4 value = fetch(source, pixel);
  bvec4 wanted = not_finite(value);
  for (int n = 1; n <= 4 && any(wanted); ++n) {
    vec4 sum = vec4(0.0), count = vec4(0.0);
    for (int y = max(pixel.y - n, 0); y <= min(pixel.y + n, target_size().y - 1); ++y)
      for (int x = max(pixel.x - n, 0); x <= min(pixel.x + n, target_size().x - 1); ++x) {
        vec4 other = fetch(source, ivec2(x, y));
        vec4 here = vec4(not(not_finite(other)));
        sum += mix(vec4(0.0), other, bvec4(here));
        count += here;
      }
    bvec4 found = bvec4(uvec4(wanted) & uvec4(greaterThan(count, vec4(0.0))));
    value = mix(value, sum / max(count, vec4(1.0)), found);
    wanted = bvec4(uvec4(wanted) & ~uvec4(found) & 1u);
  }
  return mix(value, vec4(0.0), wanted);
}
