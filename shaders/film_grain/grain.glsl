// SPDX-License-Identifier: MIT
// c·(1 + strength·noise·response curve): grain scales with light, so black stays black and colours keep their hue where it is grey.
#include "lib/color.glsl"
#include "lib/noise.glsl"

layout(constant_id = 0) const bool is_fine = true;     // one grain a pixel
layout(constant_id = 1) const bool grey = true;        // the same grain in all channels
layout(constant_id = 2) const bool is_coarse = false;  // grain of cells; both: a mix

uniform float strength;
uniform float response;
uniform vec2 size_of_grain;  // side of a cell, pixels: in 64ths, and the rest
uniform float colored;
uniform int key;     // a word of the frame and the seed
uniform vec2 shift;  // where the frame's cells begin, pixels
uniform float coarse;  // share of the grain of cells, where there are both

// Grey; and, where there is colour, red, green and blue. `row`: word_of(key ^ the cell's row).
vec4 grain(uint row, int column) {
  uint word = word_of(row + uint(column) * 0x9e3779b9u);
  vec4 sum = vec4(bytes_of(word), 0.0, 0.0, 0.0);
  if (!grey) sum.yzw = vec3(bytes_of(word_of(word + 1u)), bytes_of(word_of(word + 2u)), bytes_of(word_of(word + 3u)));
  return sum;
}
// Beside cells, which have the numbers of pixels, too, pixels have a key of their own.
vec4 pixel_grain(ivec2 pixel) { return grain(word_of(uint(key ^ pixel.y) ^ (is_coarse ? 0x80000000u : 0u)), pixel.x); }

// Between cells by quadratic B-splines, which are nearly as sharp everywhere; divided by the root of the sum of squared weights the deviation
// stays 1. Each frame has its cells elsewhere: a lattice would stand still over all of them.
vec4 coarse_grain(ivec2 pixel) {
  vec2 centre = vec2(pixel) + 0.5 + shift;
  ivec2 cell = ivec2(floor(centre / (size_of_grain.x + size_of_grain.y)));
  vec2 f = place_in_cell(centre, cell, size_of_grain), g = 1.0 - f;
  vec2 before = 0.5 * g * g, after = 0.5 * f * f, own = 1.0 - before - after;
  vec4 n = vec4(0.0);
  for (int j = -1; j <= 1; ++j) {
    float down = j < 0 ? before.y : j > 0 ? after.y : own.y;
    uint row = word_of(uint(key ^ (cell.y + j)));
    n += down * (before.x * grain(row, cell.x - 1) + own.x * grain(row, cell.x) + after.x * grain(row, cell.x + 1));
  }
  vec2 squares = before * before + own * own + after * after;
  return (n - kBytesMean) * inversesqrt(squares.x * squares.y);
}

// What makes the deviation that of one of two kinds of noise that know nothing of each other, where `share` is of the second.
float deviation_of_one(float share) { return inversesqrt(share * share + (1.0 - share) * (1.0 - share)); }

vec4 noise(ivec2 pixel) {
  if (!is_fine) return coarse_grain(pixel);
  vec4 fine = pixel_grain(pixel) - kBytesMean;
  return is_coarse ? (fine + coarse * (coarse_grain(pixel) - fine)) * deviation_of_one(coarse) : fine;
}

vec4 apply(vec4 color, ivec2 pixel) {
  vec4 each = kBytesScale * noise(pixel);
  vec3 n = grey ? each.rrr : lerp(each.rrr, each.gba, colored) * deviation_of_one(colored);
  float less = 1.0 - response * sqrt(clamp(luminance(color.rgb), 0.0, 1.0));
  return vec4(clamp(color.rgb * (1.0 + strength * less * n), 0.0, kMaxLight), color.a);
}
