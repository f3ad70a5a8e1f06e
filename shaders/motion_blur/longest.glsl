// SPDX-License-Identifier: MIT
// The longest motion of each `block` texels along one axis; of equal ones the first.
layout(constant_id = 0) const bool down = false;  // along y; else along x

uniform sampler2D source;
uniform int block;

vec4 sample_at(ivec2 pixel) {
  ivec2 size = image_size(source), axis = down ? ivec2(0, 1) : ivec2(1, 0);
  ivec2 first = pixel + axis * pixel * (block - 1);
  int count = min(block, down ? size.y - first.y : size.x - first.x);
  vec4 most = fetch(source, first);
  for (int i = 1; i < count; ++i) {
    vec4 read = fetch(source, first + i * axis);
    if (read.w > most.w) most = read;
  }
  return most;
}
