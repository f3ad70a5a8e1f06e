// SPDX-License-Identifier: MIT
// Noise from integers: the same on every device and in every run.

/// Three random words of three (pcg3d: M. Jarzynski, M. Olano, "Hash Functions for GPU Rendering", JCGT 9/3, 2020).
uvec3 pcg3d(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

/// Each word's upper 24 bits as a number in 0…1, exact.
vec3 unit_of(uvec3 words) { return vec3(words >> 8u) * (1.0 / 16777216.0); }

/// A random word of one (lowbias32: C. Wellons, "Prospecting for Hash Functions", 2018), for a fifth of what pcg3d costs.
uint word_of(uint x) {
  x = (x ^ (x >> 16u)) * 0x7feb352du;
  x = (x ^ (x >> 15u)) * 0x846ca68bu;
  return x ^ (x >> 16u);
}

/// The sum of a word's four bytes, which is nearly normal: 0…1020, mean 510, deviation 1/kBytesScale.
float bytes_of(uint word) {
  uint pairs = (word & 0x00ff00ffu) + ((word >> 8u) & 0x00ff00ffu);
  return float(int((pairs + (pairs >> 16u)) & 0xffffu));
}
const float kBytesMean = 510.0;
const float kBytesScale = 0.00676588;

/// Where `point` (pixels) lies within or beside a cell of a square grid, in sides of a cell: 0…1 within. `side` is the cells' side in
/// pixels in two parts, the first a multiple of 1/64: a cell's number times that is exact, so that far cells have as many digits as near ones.
vec2 place_in_cell(vec2 point, ivec2 cell, vec2 side) { return (point - vec2(cell) * side.x - vec2(cell) * side.y) / (side.x + side.y); }
