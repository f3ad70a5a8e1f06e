// SPDX-License-Identifier: MIT
// Along each edge the way to its two ends tells how the edge slants; the pixel is then read from between itself and the other side.
#include "lib/color.glsl"

layout(constant_id = 0) const int quality = 2;

uniform sampler2D source;
uniform sampler2D luma;
uniform float fixed_threshold;
uniform float relative_threshold;
uniform float subpixel_blending;

// Behind the last step the end is guessed to be so much further.
const float kGuess = 8.0;
// The way along the edge: at high quality 4 steps of one pixel first, then one of a half more, twos, and a last of 4 (at low quality of 2).
const int kFine = quality == 2 ? 4 : 0, kLast = quality == 0 ? 2 : quality == 1 ? 7 : 5;
const int kMost = 64;  // turns, more than there are: loops that end sooner by what they find are not unfolded

float at(ivec2 pixel) { return fetch(luma, pixel).r; }

/// Luma on the line between two rows or columns: `pixel` lies on its upper or left side, the other one `over` from it.
float beside(ivec2 pixel, ivec2 over) { return 0.5 * (at(pixel) + at(pixel + over)); }

/// The same between `pixel` and the next one along the line.
float between(ivec2 pixel, ivec2 over, ivec2 next) {
  return 0.25 * ((at(pixel) + at(pixel + over)) + (at(pixel + next) + at(pixel + next + over)));
}

/// Way along `next`, or against it, until luma leaves that of the edge by `enough`; `change` is by how much it did. Pixels come first, which are two
/// reads each, and the places between two of them behind. (Loops end behind their reads: a CPU driver would take a group of pixels through them once
/// more to see that they are over.)
float way_to_end(ivec2 pixel, ivec2 over, ivec2 next, bool back, float edge, float enough, out float change) {
  ivec2 on = back ? -next : next, to = pixel;
  change = 0.0;
  for (int i = 0; i < kMost; ++i) {
    to += on;
    change = beside(to, over) - edge;
    if (i == kFine || abs(change) >= enough) break;
  }
  float half_more = 0.0;
  if (abs(change) < enough) {
    half_more = 0.5;
    if (back) to += on;  // the upper or left one of the two pixels
    for (int i = 0; i < kMost; ++i) {
      to += on * (i == 0 ? 1 : i == kLast && quality != 0 ? 4 : 2);
      change = between(to, over, next) - edge;
      if (i == kLast || abs(change) >= enough) break;
    }
  }
  ivec2 gone = abs(to - pixel);
  float way = float(gone.x + gone.y) + (back ? -half_more : half_more);
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

  // Half-way between two places luma often differs by just as much.
  float edge = 0.5 * (m + other), enough = 0.25 * abs(other - m) - 1e-5, change_p, change_n;
  ivec2 over = horizontal ? ivec2(0, 1) : ivec2(1, 0), next = 1 - over;
  ivec2 from = forward ? pixel : pixel - over;  // the upper or left one of the two sides
  float way_p = way_to_end(from, over, next, false, edge, enough, change_p);
  float way_n = way_to_end(from, over, next, true, edge, enough, change_n);
  bool rising = (way_p <= way_n ? change_p : change_n) >= 0.0;
  float slant = rising == (m >= edge) ? 0.0 : 0.5 - min(way_p, way_n) / (way_p + way_n);

  // Between the pixel and the one across the edge.
  vec4 own = fetch(source, pixel);
  return vec4(lerp(own.rgb, fetch(source, forward ? pixel + over : pixel - over).rgb, max(subpixel, slant)), own.a);
}
