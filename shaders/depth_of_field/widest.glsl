// SPDX-License-Identifier: MIT
// The widest circle in front of the focus of each `block` texels along one axis, in alpha, not below 0.
layout(constant_id = 0) const bool down = false;  // along y; else along x

uniform sampler2D source;
uniform int block;

vec4 sample_at(ivec2 pixel) {
  ivec2 size = image_size(source), axis = down ? ivec2(0, 1) : ivec2(1, 0);
  ivec2 first = pixel + axis * pixel * (block - 1);
  int count = min(block, down ? size.y - first.y : size.x - first.x);
  float widest = 0.0;
  for (int i = 0; i < count; ++i) widest = min(widest, fetch(source, first + i * axis).a);
  return vec4(0.0, 0.0, 0.0, widest);
}
