// SPDX-License-Identifier: MIT
// What several masks need. A mask is how much a pixel counts, 0…1, in every channel.
#include "lib/alpha.glsl"

// 1 between `from` and `to`, 0 beyond `soft` outside of them (> 0), smooth between.
float in_range(float x, float from, float to, float soft) {
  return smoothstep(from - soft, from, x) * (1.0 - smoothstep(to, to + soft, x));
}
