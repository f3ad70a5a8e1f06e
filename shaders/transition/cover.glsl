// SPDX-License-Identifier: MIT
// Another picture, scaled so that it covers this one, about its middle.
uniform sampler2D source;

vec4 sample_at(ivec2 pixel) {
  vec2 size = vec2(target_size()), from = vec2(image_size(source));
  float scale = min(from.x / size.x, from.y / size.y);  // texels for each pixel
  vec2 at = (vec2(pixel) + 0.5 - 0.5 * size) * scale + 0.5 * from;
  int reads = clamp(int(ceil(scale)), 1, 8);
  vec4 sum = vec4(0.0);
  for (int y = 0; y < reads; ++y)
    for (int x = 0; x < reads; ++x) sum += fetch_linear(source, at + ((vec2(x, y) + 0.5) / float(reads) - 0.5) * scale);
  return sum / float(reads * reads);
}
