// SPDX-License-Identifier: MIT
// Mean of what each block covers along one axis. Blocks of whole sides cover whole texels; others share the texels at their ends.
layout(constant_id = 0) const bool down = false;  // along y; else along x

uniform sampler2D source;
uniform float block;

vec4 sample_at(ivec2 pixel) {
  ivec2 size = image_size(source), axis = down ? ivec2(0, 1) : ivec2(1, 0);
  int at = down ? pixel.y : pixel.x, end = down ? size.y : size.x;
  ivec2 side = pixel - at * axis;
  float from = float(at) * block, to = min(from + block, float(end));
  int first = int(floor(from)), last = min(int(ceil(to)), end) - 1;
  vec4 sum = vec4(0.0), part = vec4(0.0);  // of 32 at a time, so that a long sum keeps its digits
  for (int i = first; i <= last; ++i) {
    float covered = min(float(i + 1), to) - max(float(i), from);
    part += covered * fetch(source, side + i * axis);
    if (((i - first) & 31) == 31) {
      sum += part;
      part = vec4(0.0);
    }
  }
  return (sum + part) / (to - from);
}
