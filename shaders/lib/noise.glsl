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

/// Each word as a number of mean 0 and deviation 1, within ±3.46: the sum of its four bytes is nearly normal.
vec3 normal_of(uvec3 words) {
  uvec3 sum = (words & 255u) + ((words >> 8u) & 255u) + ((words >> 16u) & 255u) + (words >> 24u);
  return (vec3(sum) - 510.0) * 0.00676588;
}

/// Where `point` (pixels) lies within or beside a cell of a square grid, in sides of a cell: 0…1 within. `side` is the cells' side in
/// pixels in two parts, the first a multiple of 1/64: a cell's number times that is exact, so that far cells have as many digits as near ones.
vec2 place_in_cell(vec2 point, ivec2 cell, vec2 side) { return (point - vec2(cell) * side.x - vec2(cell) * side.y) / (side.x + side.y); }
