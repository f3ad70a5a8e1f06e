// SPDX-License-Identifier: MIT
// Along each edge the way to its two ends tells how the edge slants; the pixel is then read from between itself and the other side.
layout(constant_id = 0) const int quality = 2;

uniform sampler2D source;
uniform sampler2D luma;
uniform float fixed_threshold;
uniform float relative_threshold;
uniform float subpixel_blending;

// Behind the last step the end is guessed to be so much further.
const float kGuess = 8.0;
const int kSteps = quality == 0 ? 3 : quality == 1 ? 8 : 10;

// How far a step goes along the edge, in pixels: at high quality a few of one first, then one of a half more, twos, and a last of 4.
float step_of(int i) {
  const int fine = quality == 2 ? 4 : 0;
  return i < fine ? 1.0 : i == fine ? 1.5 : i < kSteps - 1 || quality == 0 ? 2.0 : 4.0;
}

float at(ivec2 pixel) { return fetch(luma, pixel).r; }

/// Luma on the line between two rows or columns, `way` pixels along it from `pixel`; both are whole or halves.
float beside(vec2 pixel, float way, vec2 direction, bool horizontal) {
  ivec2 to = ivec2(floor(pixel + way * direction));
  ivec2 next = way == floor(way) ? ivec2(0) : horizontal ? ivec2(1, 0) : ivec2(0, 1), over = horizontal ? ivec2(0, 1) : ivec2(1, 0);
  float own = at(to), ahead = at(to + next), other = at(to + over), both = at(to + next + over);
  return 0.25 * (horizontal ? (own + ahead) + (other + both) : (own + other) + (ahead + both));
}

/// Way along `direction` until luma leaves that of the edge by `enough`; `change` is by how much it did.
float way_to_end(vec2 pixel, vec2 direction, bool horizontal, float edge, float enough, out float change) {
  float way = 1.0;
  change = beside(pixel, way, direction, horizontal) - edge;
  for (int i = 0; i < kSteps && abs(change) < enough; ++i) {
    way += step_of(i);
    change = beside(pixel, way, direction, horizontal) - edge;
  }
  return abs(change) < enough ? way + kGuess : way;
}

/// Luma of a pixel and of those above, below, right and left of it.
struct Cross { float m, n, s, e, w; };

Cross cross_at(ivec2 pixel) {
  return Cross(at(pixel), at(pixel + ivec2(0, -1)), at(pixel + ivec2(0, 1)), at(pixel + ivec2(1, 0)), at(pixel + ivec2(-1, 0)));
}

float highest_of(Cross c) { return max(max(max(c.n, c.s), max(c.e, c.w)), c.m); }
float range_of(Cross c) { return highest_of(c) - min(min(min(c.n, c.s), min(c.e, c.w)), c.m); }

bool done_at(ivec2 pixel, out vec4 color) {
  color = fetch(source, pixel);
  Cross c = cross_at(pixel);
  return range_of(c) < max(fixed_threshold, relative_threshold * highest_of(c));
}

vec4 sample_at(ivec2 pixel) {
  Cross c = cross_at(pixel);
  float m = c.m, n = c.n, s = c.s, e = c.e, w = c.w, range = range_of(c);
  float ne = at(pixel + ivec2(1, -1)), nw = at(pixel + ivec2(-1, -1)), se = at(pixel + ivec2(1, 1)), sw = at(pixel + ivec2(-1, 1));
  float lone = clamp(abs((2.0 * (n + s + e + w) + ne + nw + se + sw) * (1.0 / 12.0) - m) / range, 0.0, 1.0);
  lone = lone * lone * (3.0 - 2.0 * lone);
  float subpixel = lone * lone * subpixel_blending;

  float change_down = 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e) + abs(nw + sw - 2.0 * w);
  float change_across = 2.0 * abs(e + w - 2.0 * m) + abs(ne + nw - 2.0 * n) + abs(se + sw - 2.0 * s);
  // Where all terms have one sign both sums are the same, but for rounding, which must not decide.
  bool horizontal = change_down >= change_across - 1e-5;
  float ahead = horizontal ? s : e, behind = horizontal ? n : w;
  bool forward = abs(ahead - m) > abs(behind - m);
  float other = forward ? ahead : behind;
  vec2 across = (horizontal ? vec2(0.0, 1.0) : vec2(1.0, 0.0)) * (forward ? 1.0 : -1.0);
  vec2 along = horizontal ? vec2(1.0, 0.0) : vec2(0.0, 1.0);

  vec2 centre = vec2(pixel) + 0.5;
  float edge = 0.5 * (m + other), enough = 0.25 * abs(other - m), change_p, change_n;
  vec2 from = vec2(pixel) + min(across, 0.0);  // the upper or left one of the two sides
  float way_p = way_to_end(from, along, horizontal, edge, enough, change_p);
  float way_n = way_to_end(from, -along, horizontal, edge, enough, change_n);
  bool rising = (way_p <= way_n ? change_p : change_n) >= 0.0;
  float slant = rising == (m >= edge) ? 0.0 : 0.5 - min(way_p, way_n) / (way_p + way_n);

  return vec4(fetch_linear(source, centre + max(subpixel, slant) * across).rgb, fetch(source, pixel).a);
}
