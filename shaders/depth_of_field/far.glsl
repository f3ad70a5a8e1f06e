// SPDX-License-Identifier: MIT
// What lies at the focus or behind it, blurred by its own circle: sum over the iris, weights in alpha. Where something in front hides it, what
// is seen around stands for it. What is sharp counts next to nothing: it is not seen in the small picture.
#include "lib/blurred.glsl"
#include "lib/iris.glsl"

layout(constant_id = 0) const int blades = 0;  // 3 or more: straight sides
layout(constant_id = 1) const bool has_tube = false;

uniform sampler2D source;  // pyramid of the small picture, circles in alpha
uniform sampler2D middles; // of the light of the coarse levels' texels, from their centres
uniform ivec2 small;       // size of the small picture
uniform float factor;
uniform vec4 turns;
uniform vec3 stretch;      // of the iris, across and down; how soft its rim is
uniform float cat_eye;
uniform float samples;

const int kMost = 128;  // turns, more than a row has

vec4 sample_at(ivec2 pixel) {
  vec4 own = fetch(source, pixel);
  bool hidden = own.a < 0.0;
  float circle = abs(own.a), blur = blurred(circle * factor, factor), weight = max(blur, 1.0 / 4096.0);
  int level = level_for(circle, hidden ? 0.25 * samples : samples);  // what is seen around is read more sparsely
  float radius = max(before_means(circle), hidden ? 1.0 : 0.0);      // at least the next texels, or what hides would be its own background
  if (radius <= 0.0) return vec4(own.rgb, 1.0) * weight;
  vec3 tube = tube_at(vec2(pixel) + 0.5, vec2(small), cat_eye);
  float texel = float(1 << level), soft = stretch.z, reach = radius + 0.5 * soft, own_area = disc_area(radius, soft), per_circle = 1.0 / max(circle, 1e-6);
  ivec2 last = last_texel(small, level), origin = origin_of(small, level), rows = rows_of(pixel, reach / stretch.y, level);
  vec2 shift = (0.5 * texel - 0.5) - vec2(pixel);  // centres of texels, from the pixel's
  vec4 sum = vec4(0.0);
  for (int y = rows.x; y <= rows.y; y += 2) {
    float down = float(y) * texel + shift.y;
    ivec2 columns = columns_of(pixel, reach, down, stretch.xy, level);
    if (columns.x > columns.y) continue;
    for (int turn = 0, x = columns.x; turn < kMost; ++turn, x += 2) {
      // Coarse texels hold what is in front alone, where there is any: what is seen past it are single pixels of the finest level.
      ivec2 place = hidden ? clamp((ivec2(x, y) << level) + (1 << level) / 2, ivec2(0), small - 1) : origin + clamp(ivec2(x, y), ivec2(0), last);
      vec4 read = fetch(source, place);
      vec2 from = vec2(float(x) * texel + shift.x, down);
      if (level > 0 && !hidden) from += fetch(middles, place - ivec2(small.x, 0)).xy;
      float away = iris_radius(from * stretch.xy, blades, turns, tube, has_tube);
      // Nothing reaches further than its own circle, nor further over this pixel than this pixel's. Smaller circles hold more light.
      float ratio = read.a * per_circle, held = hidden ? radius : clamp(ratio, 0.0, 1.0) * radius;
      float counts = hidden ? clamp(2.0 * ratio + 1.5, 0.0, 1.0)
                            : blurred(max(read.a, 0.0) * factor, factor) * min(own_area / disc_area(held, soft), 4.0);
      sum += disc(held, away, soft) * counts * vec4(read.rgb, 1.0);
      if (x + 2 > columns.y) break;  // behind the reads: CPU drivers take no turn to see that there are no more
    }
  }
  // Where nothing is seen, and of what is all but sharp.
  return sum * (4.0 * texel * texel / own_area * weight) + vec4(own.rgb, 1.0) * max((1.0 - blur) / 4096.0, 1e-5);
}
