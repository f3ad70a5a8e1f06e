// Mean of each `block` texels along one axis.
layout(constant_id = 0) const bool down = false;  // along y; else along x

uniform sampler2D source;
uniform int block;

vec4 sample_at(ivec2 pixel) {
  ivec2 size = image_size(source), axis = down ? ivec2(0, 1) : ivec2(1, 0);
  ivec2 first = pixel + axis * pixel * (block - 1);
  int count = min(block, down ? size.y - first.y : size.x - first.x);
  vec4 sum = vec4(0.0), part = vec4(0.0);  // of 32 at a time, so that a long sum keeps its digits
  for (int i = 0; i < count; ++i) {
    part += fetch(source, first + i * axis);
    if ((i & 31) == 31) {
      sum += part;
      part = vec4(0.0);
    }
  }
  return (sum + part) / float(count);
}
