// SPDX-License-Identifier: MIT
// The same as meter.glsl: a workgroup reads the pixels of a cell side by side.
#include "lib/workgroup.glsl"
#include "lib/exposure_grid.glsl"

layout(local_size_x = 8, local_size_y = 8, pixels_x = 1, pixels_y = 1) in;

uniform sampler2D source;
layout(constant_id = 0) const bool center = false;

vec4 compute_at(ivec2 cell) {
  ivec2 size = image_size(source), cells = target_size(), own = ivec2(gl_LocalInvocationID.xy);
  ivec2 first = first_of(cell, cells, size), last = first_of(cell + 1, cells, size);
  vec2 sum = vec2(0.0);
  for (int y = first.y + own.y; y < last.y; y += 8)
    for (int x = first.x + own.x; x < last.x; x += 8) sum += metered(fetch(source, ivec2(x, y)));
  return mean_of(workgroup_sum(vec4(sum, 0.0, 0.0)).xy, cell, cells, center);
}
