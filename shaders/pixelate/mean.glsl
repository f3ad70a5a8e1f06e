// SPDX-License-Identifier: MIT
// Mean of what each block covers along one axis. Blocks of whole sides cover whole texels; others share the texels at their ends.
layout(constant_id = 0) const bool down = false;  // along y; else along x

uniform sampler2D source;
uniform int block;  // in 1/65536 of a texel

vec4 sample_at(ivec2 pixel) {
  ivec2 size = image_size(source), axis = down ? ivec2(0, 1) : ivec2(1, 0);
  int at = down ? pixel.y : pixel.x, end = down ? size.y : size.x;
  ivec2 side = pixel - at * axis;
  int from = at * block, to = min(from + block, end << 16);
  int first = from >> 16, last = (to - 1) >> 16;
  vec4 sum = vec4(0.0), part = vec4(0.0);  // of 32 at a time, so that a long sum keeps its digits
  for (int i = first; i <= last; ++i) {
    part += float(min((i + 1) << 16, to) - max(i << 16, from)) * fetch(source, side + i * axis);
    if (((i - first) & 31) == 31) {
      sum += part;
      part = vec4(0.0);
    }
  }
  return (sum + part) / float(to - from);
}
