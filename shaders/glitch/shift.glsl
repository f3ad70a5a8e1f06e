// SPDX-License-Identifier: MIT
// Reads each channel from another place of the same or a rolled line.
#include "lib/noise.glsl"

uniform sampler2D source;
uniform float line_height;
uniform int frame, seed;
uniform float quiet;  // lines whose number in 0…1 is below it stay
uniform float jump;   // the rest in widths of the picture: how far a line jumps,
uniform float shake;  // the picture,
uniform float split;  // red and blue
uniform int roll;     // rows
uniform bool stretch;  // past the sides stands their last pixel; otherwise what lies at the other side

int pixels(float widths) { return int(floor(widths * float(target_size().x) + 0.5)); }

float channel(ivec2 pixel, int shift, int which) {
  int width = target_size().x, x = pixel.x + shift;
  return fetch(source, ivec2(stretch ? clamp(x, 0, width - 1) : (x + width) % width, pixel.y))[which];
}

vec4 sample_at(ivec2 pixel) {
  vec3 of_frame = unit_of(pcg3d(uvec3(0xffffffffu, uint(seed), uint(frame))));
  float of_line = 2.0 * unit_of(pcg3d(uvec3(uint((float(pixel.y) + 0.5) / line_height), uint(seed), uint(frame)))).x - 1.0;
  int shift = pixels((of_frame.x - 0.5) * shake) + (abs(of_line) >= quiet ? pixels(of_line * jump) : 0);
  int apart = pixels((0.5 + 0.5 * of_frame.y) * split);
  ivec2 from = ivec2(pixel.x, (pixel.y + roll) % target_size().y);
  return vec4(channel(from, shift + apart, 0), channel(from, shift, 1), channel(from, shift - apart, 2), fetch(source, pixel).a);
}
