// SPDX-License-Identifier: MIT
// How much of each pixel lies beyond the line that its edge stands for: of the pixel below its upper edge (r) and of the one above (g), of the pixel right of its left edge (b)
// and of the one left of it (a).
uniform sampler2D source;  // edges
uniform int search;
uniform float rounding;

// One axis stands for both: `along` the edge, `across` from the neighbour to the pixel. `own` are edges like this one, `crossing` those that meet it.
float own(ivec2 at, bool upright) {
  vec2 e = fetch(source, at).rg;
  return upright ? e.r : e.g;
}
float crossing(ivec2 at, bool upright) {
  vec2 e = fetch(source, at).rg;
  return upright ? e.g : e.r;
}

// Area between the axis and the line from (0, y1) to (length, y2) within x … x + 1: what lies on the side of the pixel, and on that of its neighbour.
vec2 area(float x0, float y0, float x1, float y1, float x) {
  float from = max(x, x0), to = min(x + 1.0, x1);
  if (to <= from) return vec2(0.0);
  float slope = (y1 - y0) / (x1 - x0);
  float a = y0 + slope * (from - x0), b = y0 + slope * (to - x0);
  if (a * b >= 0.0) {
    float both = 0.5 * (a + b) * (to - from);
    return both > 0.0 ? vec2(both, 0.0) : vec2(0.0, -both);
  }
  float meets = a / (a - b) * (to - from);
  float first = 0.5 * abs(a) * meets, second = 0.5 * abs(b) * max(to - from - meets, 0.0);  // divisions may be rounded up
  return a > 0.0 ? vec2(first, second) : vec2(second, first);
}

// What crosses the edge at an end: 1 on the pixel's side, −1 on its neighbour's, 2 both, 0 nothing.
int end_of(float near, float far) { return near > 0.0 ? (far > 0.0 ? 2 : 1) : (far > 0.0 ? -1 : 0); }

vec2 weights_of(ivec2 pixel, bool upright) {
  ivec2 along = upright ? ivec2(0, 1) : ivec2(1, 0), across = upright ? ivec2(1, 0) : ivec2(0, 1);
  ivec2 size = image_size(source);
  int room_behind = upright ? pixel.y : pixel.x, room_ahead = (upright ? size.y - pixel.y : size.x - pixel.x) - 1;
  int behind = 0, ahead = 0;
  vec2 end_behind = vec2(0.0), end_ahead = vec2(0.0);
  for (;;) {
    ivec2 at = pixel - behind * along;
    end_behind = vec2(crossing(at, upright), crossing(at - across, upright));
    if (end_behind.x + end_behind.y > 0.0 || behind >= min(search, room_behind) || own(at - along, upright) == 0.0) break;
    ++behind;
  }
  for (;;) {
    ivec2 at = pixel + (ahead + 1) * along;
    bool edge = ahead >= room_ahead;  // the picture ends
    end_ahead = edge ? vec2(0.0) : vec2(crossing(at, upright), crossing(at - across, upright));
    if (edge || end_ahead.x + end_ahead.y > 0.0 || ahead >= search || own(at, upright) == 0.0) break;
    ++ahead;
  }
  int first = end_of(end_behind.x, end_behind.y), second = end_of(end_ahead.x, end_ahead.y);
  // What crosses on both sides goes on as the other end does not.
  int whole_first = first;
  if (first == 2) first = abs(second) == 1 ? -second : 0;
  if (second == 2) second = abs(whole_first) == 1 ? -whole_first : 0;
  float x = float(behind), size_of_edge = float(behind + ahead + 1), middle = 0.5 * size_of_edge;
  vec2 result = vec2(0.0);
  if (first != 0 && second == -first) {
    result = area(0.0, 0.5 * float(first), size_of_edge, 0.5 * float(second), x);
  } else if (first != 0 && second != 0) {
    vec2 a = area(0.0, 0.5 * float(first), middle, 0.0, x), b = area(middle, 0.0, size_of_edge, 0.5 * float(second), x);
    float plain = clamp(size_of_edge / 32.0, 0.0, 1.0);  // short ones are smoothed more
    result = mix(sqrt(2.0 * a) * 0.5, a, plain) + mix(sqrt(2.0 * b) * 0.5, b, plain);
  } else if (first != 0 && behind <= ahead) {
    result = area(0.0, 0.5 * float(first), middle, 0.0, x);
  } else if (second != 0 && behind >= ahead) {
    result = area(middle, 0.0, size_of_edge, 0.5 * float(second), x);
  }
  // Where a line goes on straight beyond the crossing, there is a corner.
  vec2 nearer = vec2(behind <= ahead ? 1.0 : 0.0, ahead <= behind ? 1.0 : 0.0);
  nearer *= rounding / (nearer.x + nearer.y);
  ivec2 start = pixel - behind * along, finish = pixel + (ahead + 1) * along;
  vec2 kept = vec2(1.0);
  kept.x -= nearer.x * crossing(start + across, upright) + nearer.y * crossing(finish + across, upright);
  kept.y -= nearer.x * crossing(start - 2 * across, upright) + nearer.y * crossing(finish - 2 * across, upright);
  return result * clamp(kept, 0.0, 1.0);
}

bool done_at(ivec2 pixel, out vec4 color) {
  color = vec4(0.0);
  return fetch(source, pixel).rg == vec2(0.0);
}

vec4 sample_at(ivec2 pixel) {
  vec2 edges = fetch(source, pixel).rg;
  vec4 result = vec4(0.0);
  if (edges.g > 0.0) result.rg = weights_of(pixel, false);
  if (edges.r > 0.0) result.ba = weights_of(pixel, true);
  return result;
}
