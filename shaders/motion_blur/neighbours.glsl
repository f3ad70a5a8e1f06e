// SPDX-License-Identifier: MIT
// The longest motion of a tile and its eight neighbours; of equal ones the first, from the upper left.
uniform sampler2D source;

vec4 sample_at(ivec2 pixel) {
  vec4 most = vec4(0.0);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      vec4 read = fetch(source, pixel + ivec2(x, y));
      if (read.w > most.w) most = read;
    }
  return most;
}
