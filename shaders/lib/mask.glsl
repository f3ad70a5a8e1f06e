// SPDX-License-Identifier: MIT
// What several masks need. A mask is how much a pixel counts, 0…1, in every channel.
#include "lib/alpha.glsl"

// 0 to 1, smooth at both ends; t may lie outside.
float smooth_share(float t) {
  t = clamp(t, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// 1 between `from` and `to`, 0 beyond `soft` outside of them (> 0), smooth between. What is divided are distances from the ends: where these are
// large, `from - soft` is `from` again.
float in_range(float x, float from, float to, float soft) {
  return smooth_share(1.0 + (x - from) / soft) * smooth_share(1.0 - (x - to) / soft);
}
