// SPDX-License-Identifier: MIT
// Coverage of the wanted objects in one image of a cryptomatte, which has two ranks of (id, coverage) a pixel, added to that of the images
// before it.
layout(constant_id = 0) const bool first = true;
uniform vec4 ids_a;  // one id may stand there several times
uniform vec4 ids_b;

float counts(float id) { return any(equal(vec4(id), ids_a)) || any(equal(vec4(id), ids_b)) ? 1.0 : 0.0; }

vec4 apply(vec4 color, vec4 ranks, vec4 before) {
  return vec4((first ? 0.0 : before.r) + counts(ranks.r) * ranks.g + counts(ranks.b) * ranks.a);
}
