// SPDX-License-Identifier: MIT
// What lies in front of the focus, spread over everything around it: its light, and how much of what is behind it covers, in alpha.
#include "lib/blurred.glsl"
#include "lib/iris.glsl"

layout(constant_id = 0) const int blades = 0;  // 3 or more: straight sides
layout(constant_id = 1) const bool has_tube = false;

uniform sampler2D source;  // pyramid of the small picture, circles in alpha
uniform sampler2D middles; // of the light of the coarse levels' texels, from their centres
uniform sampler2D widest;  // circle in front of the focus around, by tile
uniform float tiles;       // in a pixel: 1 / their side
uniform ivec2 small;       // size of the small picture
uniform float factor;
uniform vec4 turns;
uniform vec3 stretch;      // of the iris, across and down; how soft its rim is
uniform float cat_eye;
uniform float samples;
uniform float part;        // of a disc that the iris is

const int kMost = 128;  // turns, more than a row has

vec4 sample_at(ivec2 pixel) {
  float around = -fetch(widest, ivec2((vec2(pixel) + 0.5) * tiles)).a;
  int coarsest = blurred(around * factor, factor) <= 0.0 ? -1 : level_for(around, samples);
  vec3 tube = tube_at(vec2(pixel) + 0.5, vec2(small), cat_eye);
  float soft = stretch.z, open = part * open_part(has_tube ? tube.z : 0.0);
  vec4 sum = vec4(0.0);
  // Circles that are small beside a coarse level's texels are read from the finest one.
  for (int level = coarsest; level >= 0; level = level > 0 ? 0 : -1) {
    float texel = float(1 << level), split = coarsest > 0 ? float(2 << coarsest) : 1.0;
    float shrink = before_means(around) / around, reach = max((level < coarsest ? split : around) * shrink, 0.5 * soft) + 0.5 * soft;
    float from = level < coarsest ? 2.0 : coarsest > 0 ? -1.0 : 1.0, slope = level < coarsest ? -2.0 / split : coarsest > 0 ? 2.0 / split : 0.0;
    ivec2 last = last_texel(small, level), origin = origin_of(small, level), rows = rows_of(pixel, reach / stretch.y, level);
    vec2 shift = (0.5 * texel - 0.5) - vec2(pixel);  // centres of texels, from the pixel's
    vec4 level_sum = vec4(0.0);
    for (int y = rows.x; y <= rows.y; y += 2) {
      float down = float(y) * texel + shift.y;
      ivec2 columns = columns_of(pixel, reach, down, stretch.xy, level);
      if (columns.x > columns.y) continue;
      for (int turn = 0, x = columns.x; turn < kMost; ++turn, x += 2) {
        ivec2 place = origin + clamp(ivec2(x, y), ivec2(0), last);
        vec4 read = fetch(source, place);
        vec2 from_here = vec2(float(x) * texel + shift.x, down);
        if (level > 0) from_here += fetch(middles, place - ivec2(small.x, 0)).xy;
        float circle = max(-read.a, 0.0), radius = max(circle * shrink, 0.5 * soft);
        float away = iris_radius(from_here * stretch.xy, blades, turns, tube, has_tube);
        float counts = disc(radius, away, soft) * blurred(circle * factor, factor) * clamp(from + circle * slope, 0.0, 1.0) / disc_area(radius, soft);
        level_sum += counts * vec4(read.rgb, 1.0);
        if (x + 2 > columns.y) break;  // behind the reads: CPU drivers take no turn to see that there are no more
      }
    }
    sum += level_sum * (4.0 * texel * texel);
  }
  return sum / open;
}
