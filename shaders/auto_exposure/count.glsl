// SPDX-License-Identifier: MIT
// Two bins of the histogram of one row of the grid: weight and weight·EV of each. A value between two bins counts for both, so that nothing
// jumps; their means are those of the values, so that the width of the bins does not show.
#include "lib/exposure.glsl"

uniform sampler2D grid;  // EV, weight

vec4 sample_at(ivec2 pixel) {
  vec2 bins = vec2(2 * pixel.x) + vec2(0, 1);
  vec4 sum = vec4(0.0);
  int width = image_size(grid).x;
  for (int x = 0; x < width; ++x) {
    vec2 cell = fetch(grid, ivec2(x, pixel.y)).xy;
    vec2 share = cell.y * max(1.0 - abs(bins - bin_of_ev(cell.x)), 0.0);
    sum += vec4(share.x, share.x * cell.x, share.y, share.y * cell.x);
  }
  return sum;
}
