// SPDX-License-Identifier: MIT
// The median of a few values, of the two in the middle the larger: where half of them is something else, it still is one of those that are there,
// not a mean between them.
uniform sampler2D values;

vec4 sample_at(ivec2 pixel) {
  ivec2 size = image_size(values);
  int count = size.x * size.y;
  float median = 0.0;
  for (int i = 0; i < count; ++i) {
    float value = fetch(values, ivec2(i % size.x, i / size.x)).r;
    int below = 0;
    for (int j = 0; j < count; ++j) {
      float other = fetch(values, ivec2(j % size.x, j / size.x)).r;
      below += other < value || (other == value && j < i) ? 1 : 0;
    }
    if (below == count / 2) median = value;
  }
  return vec4(median, 0.0, 0.0, 1.0);
}
