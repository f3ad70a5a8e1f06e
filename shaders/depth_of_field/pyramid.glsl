// SPDX-License-Identifier: MIT
// Three levels in one image: the finest at the left, the others one below the other beside it.
uniform sampler2D source;
uniform sampler2D second;
uniform sampler2D third;

vec4 sample_at(ivec2 pixel) {
  ivec2 beside = pixel - ivec2(image_size(source).x, 0);
  if (beside.x < 0) return fetch(source, pixel);
  int rows = image_size(second).y;
  if (beside.y < rows) return fetch(second, beside);
  return fetch(third, beside - ivec2(0, rows));
}
