// SPDX-License-Identifier: MIT
// Each pixel shows its block; one that lies on two or four shows as much of each as it covers. Alpha of the picture.
uniform sampler2D source;
uniform sampler2D picture;
uniform int block;  // in 1/65536 of a pixel

vec4 sample_at(ivec2 pixel) {
  ivec2 from = pixel << 16;
  ivec2 here = ivec2(vec2(pixel) * 65536.0 / float(block));
  here -= ivec2(greaterThan(here * block, from));  // a quotient that was rounded up
  vec2 next = vec2(clamp(from + 65536 - (here + 1) * block, 0, 65536)) * (1.0 / 65536.0);  // how much lies on the blocks behind
  vec3 c = fetch(source, here).rgb;
  if (next.x > 0.0 || next.y > 0.0) {
    vec3 upper = c * (1.0 - next.x) + fetch(source, here + ivec2(1, 0)).rgb * next.x;
    vec3 lower = fetch(source, here + ivec2(0, 1)).rgb * (1.0 - next.x) + fetch(source, here + 1).rgb * next.x;
    c = upper * (1.0 - next.y) + lower * next.y;
  }
  return vec4(c, fetch(picture, pixel).a);
}
