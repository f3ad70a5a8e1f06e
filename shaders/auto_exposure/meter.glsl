// SPDX-License-Identifier: MIT
// Mean exposure value of the pixels that a cell of the grid covers, and how much the cell counts.
#include "lib/exposure_grid.glsl"

uniform sampler2D source;
layout(constant_id = 0) const bool center = false;

vec4 sample_at(ivec2 cell) {
  ivec2 size = image_size(source), cells = target_size();
  ivec2 first = first_of(cell, cells, size), last = first_of(cell + 1, cells, size);
  vec2 sum = vec2(0.0);
  for (int y = first.y; y < last.y; ++y)
    for (int x = first.x; x < last.x; ++x) sum += metered(fetch(source, ivec2(x, y)));
  return mean_of(sum, cell, cells, center);
}
