// SPDX-License-Identifier: MIT
// Lines on which 3×3 pixels decide: their mean ({1, 2, 1}/4 each way), steepened so that a line one pixel wide stays as strong as it is and gets soft sides:
// teeth close, and a single pixel all but goes.
uniform sampler2D source;
uniform float share;

vec4 sample_at(ivec2 pixel) {
  float own = fetch(source, pixel).r, strongest = own, mean = 0.25 * own;
  for (int i = -1; i <= 1; i += 2) {
    vec4 around = vec4(fetch(source, pixel + ivec2(i, 0)).r, fetch(source, pixel + ivec2(0, i)).r, fetch(source, pixel + ivec2(i, i)).r, fetch(source, pixel + ivec2(i, -i)).r);
    mean += dot(around, vec4(0.125, 0.125, 0.0625, 0.0625));
    strongest = max(strongest, max(max(around.x, around.y), max(around.z, around.w)));
  }
  return vec4(mix(own, clamp((mean - 0.2 * strongest) * (1.0 / 0.3), 0.0, strongest), share));
}
