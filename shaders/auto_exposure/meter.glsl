// Mean exposure value of the pixels that a cell of the grid covers, and how much the cell counts.
#include "lib/color.glsl"

uniform sampler2D source;
layout(constant_id = 0) const bool center = false;

const float kMiddleGrey = 0.18;
const float kDarkest = 2.7465820e-06;  // 0.18 · 2^-16: darker light is not told apart

vec4 sample_at(ivec2 cell) {
  ivec2 size = image_size(source), cells = target_size();
  ivec2 first = cell * size / cells, last = (cell + 1) * size / cells;
  float sum = 0.0;
  for (int y = first.y; y < last.y; ++y)
    for (int x = first.x; x < last.x; ++x) sum += log2(max(luminance(fetch(source, ivec2(x, y)).rgb), kDarkest) / kMiddleGrey);
  int count = (last.x - first.x) * (last.y - first.y);
  vec2 from_center = (vec2(cell) + 0.5) / vec2(cells) * 2.0 - 1.0;
  float weight = center ? exp(-2.0 * dot(from_center, from_center)) : 1.0;
  return vec4(sum / float(count), weight * float(count), 0.0, 1.0);
}
