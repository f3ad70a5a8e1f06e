// SPDX-License-Identifier: MIT
// A box with letters: their light, multiplied by how much they cover, and that. Formulas: docs/math.md §55.
#include "lib/color.glsl"

uniform sampler2D font;    // distances from the edges of letters
uniform vec4 letters[64];  // cells of the font, row by row
uniform ivec2 cells;       // columns and rows of the text
uniform vec2 origin, box;  // the box within this image, in pixels
uniform float line;        // height of a line, in pixels
uniform int reads;         // for each pixel, on each axis
uniform vec3 ink, ground;
uniform float opacity, outline;

const ivec2 kCell = ivec2(24, 48);
const int kColumns = 32;     // of the font
const float kSpread = 12.0;  // texels between the values 0 and 1
const float kOutside = -6.0;

// How far a place of the text, in texels of the font, is within the letter of one of its cells.
float within(vec2 at, ivec2 cell) {
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, cells))) return kOutside;
  int place = cell.y * cells.x + cell.x;
  int letter = int(letters[clamp(place / 4, 0, 63)][place & 3]);
  vec2 from = at - vec2(cell * kCell);
  vec2 near = clamp(from, vec2(0.5), vec2(kCell) - 0.5);  // not into the font's next letter
  vec2 texel = near + vec2(ivec2(letter % kColumns, letter / kColumns) * kCell);
  return (fetch_linear(font, texel).r - 0.5) * kSpread - length(from - near);
}

// Letters, and their outlines the more, reach a little into the cells beside them, above and below.
float within_text(vec2 at) {
  ivec2 cell = ivec2(floor(at / vec2(kCell)));
  int other = fract(at.y / float(kCell.y)) < 0.5 ? -1 : 1;
  float inside = kOutside;
  for (int y = 0; y < 2; ++y)
    for (int x = -1; x < 2; ++x) inside = max(inside, within(at, cell + ivec2(x, y * other)));
  return inside;
}

// Letters, and they with their outline.
vec2 covered(vec2 at) {
  float scale = line / float(kCell.y);
  float slope = max(scale * float(reads), 0.5);  // where the font ends, nothing is covered
  vec2 sum = vec2(0.0);
  for (int y = 0; y < reads; ++y)
    for (int x = 0; x < reads; ++x) {
      vec2 place = (at + (vec2(x, y) + 0.5) / float(reads) - 0.5 - origin - line * vec2(0.25, 0.1)) / scale;
      float inside = within_text(place);
      sum += clamp(vec2(inside, inside + outline * float(kCell.y)) * slope + 0.5, 0.0, 1.0);
    }
  return sum / float(reads * reads);
}

vec4 sample_at(ivec2 pixel) {
  vec2 from = vec2(pixel);
  vec2 shown = clamp(min(from + 1.0, origin + box) - max(from, origin), 0.0, 1.0);
  vec2 letter = covered(from + 0.5);
  float under = opacity * shown.x * shown.y * (1.0 - letter.y);
  vec3 light = clamp(ink, 0.0, kMaxLight) * letter.x + clamp(ground, 0.0, kMaxLight) * (letter.y - letter.x + under);
  return vec4(light, letter.y + under);
}
