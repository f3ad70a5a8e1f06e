// SPDX-License-Identifier: MIT
// The widest circle of a tile and its eight neighbours: whatever reaches a pixel of the tile. In alpha, below 0 as all in front of the focus.
uniform sampler2D source;

vec4 sample_at(ivec2 pixel) {
  float widest = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) widest = min(widest, fetch(source, pixel + ivec2(x, y)).a);
  return vec4(0.0, 0.0, 0.0, widest);
}
