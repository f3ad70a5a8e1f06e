// SPDX-License-Identifier: MIT
// What crosses a pixel while the shutter is open. Along its own way lies what it is blurred with; what is in front of it and moves
// otherwise comes along the longest way around, or along the one that leads farthest aside of that. A way is read once for each pixel of its longer
// axis, between the two pixels there, and each read counts for the part of its length that the way covers: so a way of half a pixel more blurs by
// half a pixel more.
#include "lib/color.glsl"
#include "lib/edge_pixels.glsl"
#include "lib/ways.glsl"

layout(constant_id = 0) const bool sparse = false;  // ways may be longer than `samples` reads

uniform sampler2D source;   // half ways and nearness
uniform sampler2D picture;
uniform sampler2D longest;  // half ways, by tile: the longest around, and the one that leads farthest aside of it
uniform float tiles;  // in a pixel: 1 / their side
uniform int samples;
uniform float hardness;  // 1 / the difference of nearness that is in front

const int kMost = 512;  // turns, more than there are

/// The ways around a pixel. (Division of whole numbers is slow on CPU devices; this is the same for sides up to 16384.)
vec4 around(ivec2 pixel) { return fetch(longest, ivec2((vec2(pixel) + 0.5) * tiles)); }

float longer(vec2 way) { return max(abs(way.x), abs(way.y)); }

/// How much of the read `i` steps away a way of `steps` covers.
float covered(float i, float steps) { return clamp(steps + 0.5 - i, 0.0, 1.0); }

/// Square of the difference of two ways; which end of a way comes first decides nothing.
float unlike(vec2 a, vec2 b) { return max(dot(a, a) + dot(b, b) - 2.0 * abs(dot(a, b)), 1e-6); }

/// Unit normal of a way; any where there is none.
vec2 normal_of(vec2 way) {
  float length_of_way = length(way);
  return length_of_way > 1e-6 ? vec2(-way.y, way.x) / length_of_way : vec2(0.0, 1.0);
}

/// Square of how far a motion is from a line.
float off(vec2 motion, vec2 normal) {
  float by = dot(motion, normal);
  return by * by + 1e-6;
}

/// Unit normals of the ways that a pixel follows: its own, the longest around, and the one farthest aside of that. Next to no motion leads beyond
/// the second or the third, but many lead beyond its own. How much the second and the third count.
struct Ways {
  vec2 own, second, third;
  float length_of_own, two, three;
};

/// A way to follow, on both sides of the pixel.
struct Way {
  vec2 per_step;        // how many steps a motion is along it, by their dot product
  float slope, steps;   // aside for each step; steps from the pixel to the end
  ivec2 along, across;  // the longer axis, and the other one
  int reads;            // 0: it is not followed
};

Way way_along(vec2 way, bool follows) {
  float length_of_way = longer(way);
  // No more reads than there may be: each then stands for several pixels.
  float apart = sparse ? max(1.0, ceil((2.0 * length_of_way - 0.3) / float(samples))) : 1.0;
  vec2 step = way * (apart / length_of_way);
  bool flat_way = abs(way.x) >= abs(way.y);
  ivec2 across = flat_way ? ivec2(0, 1) : ivec2(1, 0);
  ivec2 along = (1 - across) * (int(apart) * ((flat_way ? way.x : way.y) < 0.0 ? -1 : 1));
  float steps = sparse ? length_of_way / apart : length_of_way;
  return Way(step / dot(step, step), flat_way ? step.y : step.x, steps, along, across, follows ? int(floor(steps + 0.5)) : 0);
}

/// Sums of colours and weights.
struct Sums {
  vec4 behind;  // what is not in front and comes along
  vec4 front;   // what is in front, by the share of the time
  vec4 past;    // what is seen where the pixel itself has left
  float gone;   // how much that counts beside `behind`
};

/// Adds one pixel, `i` steps along the way. `share`: how much of it lies on the way; `inside`: how much of its step the way covers, 0 on a way
/// that is not the pixel's own; `which`: that way's one of the three; `counts`: weight in what is seen where the pixel in the middle has left,
/// `stirs`: 1 over the square of its way. Returns how much it leaves this one behind.
float count(inout Sums sums, float counts, float stirs, ivec2 at, float share, float i, float inside, vec2 per_step, vec3 which, vec4 own, Ways ways) {
  vec4 read = fetch(source, at);
  float nearer = clamp((read.z - own.z) * hardness, -1.0, 1.0), in_front = max(nearer, 0.0);
  // What is in front passes over this pixel for as long as its own motion along this way says. It is shared out to the ways that it is near to.
  float steps = abs(dot(read.xy, per_step));
  float beyond = max(abs(dot(read.xy, vec2(ways.own.y, -ways.own.x))) - ways.length_of_own, 0.0);
  float first = off(read.xy, ways.own) + beyond * beyond, second = off(read.xy, ways.second), third = off(read.xy, ways.third);
  vec3 near = vec3(second * third, ways.two * first * third, ways.three * first * second);
  float passes = share * in_front * covered(i, steps) * dot(which, near) / (2.0 * max(steps, 0.5) * (near.x + near.y + near.z));
  float stays = share * inside * (1.0 - in_front);
  vec3 color = fetch(picture, at).rgb;
  sums.front += passes * vec4(color, 1.0);
  // What is behind and does not come along is seen here for as long, but not from there: bright lights would be smeared into what hides
  // them. So the nearest of it counts; not the very first, as edge pixels hold light of what is in front.
  float leaves = max(-nearer, 0.0) * min(unlike(read.xy, own.xy) * stirs, 1.0), gone = stays * leaves;
  sums.behind += (stays - gone) * vec4(color, 1.0);
  sums.past += gone * counts * vec4(color, 1.0);
  sums.gone += gone;
  return leaves * share;
}

/// How much something in front passes over its neighbour.
float before(vec4 read, vec4 own) {
  float moves = clamp(longer(read.xy) - 0.5, 0.0, 1.0) * min(unlike(read.xy, own.xy) / max(dot(read.xy, read.xy), 0.25), 1.0);
  return clamp((read.z - own.z) * hardness, 0.0, 1.0) * moves;
}

/// An edge pixel holds light of what is in front, but stays as what is behind: its neighbours away from the edge stand for it.
vec3 behind_edge(vec3 color, ivec2 pixel, vec4 own) {
  vec2 away = vec2(0.0);
  float edge = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      float hides = before(fetch(source, pixel + ivec2(x, y)), own);
      away -= hides * vec2(x, y);
      edge = max(edge, hides);
    }
  if (edge <= 0.0) return color;
  vec4 sum = vec4(color, 1.0) * 1e-3;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = pixel + ivec2(x, y);
      sum += away_from(away, vec2(x, y)) * (1.0 - before(fetch(source, at), own)) * vec4(fetch(picture, at).rgb, 1.0);
    }
  return mix(color, sum.rgb / sum.a, edge);
}

// Nothing around moves by a pixel.
bool done_at(ivec2 pixel, out vec4 color) {
  color = fetch(picture, pixel);
  return longer(around(pixel).xy) <= 0.5;
}

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(picture, pixel);
  vec4 way = around(pixel);
  vec4 own = fetch(source, pixel);
  Sums sums = Sums(vec4(0.0, 0.0, 0.0, 1.0), vec4(0.0), vec4(0.0), 0.0);
  // Halved by each pixel on a side that this one leaves behind.
  vec2 clear = vec2(1.0);
  float stirs = 1.0 / max(dot(own.xy, own.xy), 0.25);
  float two = unlike(way.xy, own.xy) > 0.25 ? 1.0 : 0.0;
  // One that leads little aside of the longest is left to it.
  float aside_of = clamp(4.0 * between(way.xy, way.zw) / max(dot(way.xy, way.xy), 0.25) - 1.0, 0.0, 1.0);
  float three = unlike(way.zw, own.xy) > 0.25 ? aside_of : 0.0;
  Ways ways = Ways(normal_of(own.xy), normal_of(way.xy), normal_of(way.zw), length(own.xy), two, three);
  // Its own way first, on which what is not in front counts too; in one loop, as a group of pixels goes through each loop at least once.
  Way first = way_along(own.xy, longer(own.xy) > 0.5), second = way_along(way.xy, two > 0.0), third = way_along(way.zw, three > 0.0);
  int before_third = first.reads + second.reads, reads = before_third + third.reads;
  if (reads > 0)
    for (int k = 0; k < kMost; ++k) {
      bool is_first = k < first.reads, is_third = k >= before_third;
      vec2 per_step = is_first ? first.per_step : is_third ? third.per_step : second.per_step;
      ivec2 along = is_first ? first.along : is_third ? third.along : second.along;
      ivec2 across = is_first ? first.across : is_third ? third.across : second.across;
      vec3 which = is_first ? vec3(1.0, 0.0, 0.0) : is_third ? vec3(0.0, 0.0, 1.0) : vec3(0.0, 1.0, 0.0);
      int i = 1 + k - (is_first ? 0 : is_third ? before_third : first.reads);
      float inside = is_first ? covered(float(i), first.steps) : 0.0;
      float aside = float(i) * (is_first ? first.slope : is_third ? third.slope : second.slope), whole = floor(aside), rest = aside - whole;
      ivec2 to = i * along + int(whole) * across;
      vec2 counts = (clear - clear * clear + 1e-3) / float(i * i), leaves = vec2(0.0);
      leaves.x = count(sums, counts.x, stirs, pixel + to, 1.0 - rest, float(i), inside, per_step, which, own, ways);
      leaves.x += count(sums, counts.x, stirs, pixel + to + across, rest, float(i), inside, per_step, which, own, ways);
      leaves.y = count(sums, counts.y, stirs, pixel - to, 1.0 - rest, float(i), inside, per_step, which, own, ways);
      leaves.y += count(sums, counts.y, stirs, pixel - to - across, rest, float(i), inside, per_step, which, own, ways);
      clear -= 0.5 * leaves * clear;
      if (k + 1 == reads) break;
    }
  vec4 behind = sums.behind + vec4(sums.front.a > 0.0 ? behind_edge(color.rgb, pixel, own) : color.rgb, sums.gone);
  if (sums.gone > 0.0) behind.rgb += sums.past.rgb * (sums.gone / max(sums.past.a, 1e-20));
  vec3 result = behind.rgb * (max(1.0 - sums.front.a, 0.0) / behind.a) + sums.front.rgb / max(sums.front.a, 1.0);
  return vec4(result, color.a);
}
