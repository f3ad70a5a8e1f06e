// SPDX-License-Identifier: MIT
// Of `block` texels along one axis the longest way (xy), and the one that leads farthest aside of it (zw); of equal ones the first. Both are as
// long as they were before they were held.
#include "lib/ways.glsl"

layout(constant_id = 0) const bool down = false;  // along y, of what this shader made along x; else along x, of ways

uniform sampler2D source;
uniform int block;

vec4 sample_at(ivec2 pixel) {
  ivec2 size = image_size(source), axis = down ? ivec2(0, 1) : ivec2(1, 0);
  ivec2 first = pixel + axis * pixel * (block - 1);
  int count = min(block, down ? size.y - first.y : size.x - first.x);
  vec2 most = vec2(0.0), aside = vec2(0.0);
  for (int i = 0; i < count; ++i) {
    vec4 read = fetch(source, first + i * axis);
    most = longer_of(most, down ? read.xy : read.xy * read.w);
  }
  for (int i = 0; i < count; ++i) {
    vec4 read = fetch(source, first + i * axis);
    aside = farther_aside(most, aside, down ? read.xy : read.xy * read.w);
    if (down) aside = farther_aside(most, aside, read.zw);
  }
  return vec4(most, aside);
}
