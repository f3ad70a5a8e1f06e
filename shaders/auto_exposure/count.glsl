// Four bins of the histogram of one row of the grid. A value between two bins counts for both, so that nothing jumps.
#include "lib/exposure.glsl"

uniform sampler2D grid;  // EV, weight

vec4 sample_at(ivec2 pixel) {
  vec4 bins = vec4(4 * pixel.x) + vec4(0, 1, 2, 3), sum = vec4(0.0);
  int width = image_size(grid).x;
  for (int x = 0; x < width; ++x) {
    vec2 cell = fetch(grid, ivec2(x, pixel.y)).xy;
    sum += cell.y * max(1.0 - abs(bins - bin_of_ev(cell.x)), 0.0);
  }
  return sum;
}
