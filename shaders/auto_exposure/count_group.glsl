// SPDX-License-Identifier: MIT
// The same as count.glsl: a workgroup makes the bins of one row, and reads each cell of it once.
#include "lib/exposure.glsl"

layout(local_size_x = 32, local_size_y = 4, pixels_x = 32, pixels_y = 1) in;

uniform sampler2D grid;  // EV, weight

const int kMostCells = 128;

shared vec2 cells[kMostCells];

vec4 compute_at(ivec2 pixel) {
  int width = min(image_size(grid).x, kMostCells);
  for (int x = int(gl_LocalInvocationIndex); x < width; x += 128) cells[x] = fetch(grid, ivec2(x, pixel.y)).xy;
  barrier();
  vec2 bins = vec2(2 * pixel.x) + vec2(0, 1);
  vec4 sum = vec4(0.0);
  for (int x = 0; x < width; ++x) {
    vec2 cell = cells[x];
    vec2 share = cell.y * max(1.0 - abs(bins - bin_of_ev(cell.x)), 0.0);
    sum += vec4(share.x, share.x * cell.x, share.y, share.y * cell.x);
  }
  return sum;
}
