// SPDX-License-Identifier: MIT
// The iris, and which texels a pixel reads.
//
// A pixel reads every second texel across and down, and its neighbours those between, so that the mean over 2×2 pixels has read each texel
// once: no pattern is left. Where circles are wide, texels are those of a coarser level. Nothing but whole numbers decides what is read.

/// Towards the corners of the picture the tube of the lens hides parts of the iris: the direction there (xy), and how much of it (z).
vec3 tube_at(vec2 place, vec2 size, float cat_eye) {
  vec2 from_centre = place - 0.5 * size;
  float away = length(from_centre);
  return vec3(from_centre / max(away, 1e-3), cat_eye * away / (0.5 * length(size)));
}

/// Radius of the smallest iris that has the point on its rim. `turns`: direction of its first side (xy), and from side to side (zw).
float iris_radius(vec2 point, int blades, vec4 turns, vec3 tube, bool has_tube) {
  float radius = 0.0;
  if (blades < 3) {
    radius = length(point);
  } else {
    vec2 side = turns.xy;
    for (int i = 0; i < blades; ++i) {
      radius = max(radius, dot(side, point));
      side = vec2(side.x * turns.z - side.y * turns.w, side.x * turns.w + side.y * turns.z);
    }
  }
  if (has_tube) {
    // What two circles share that lie `tube.z` radii apart: (|across| + z·r/2)² + along² = r².
    float across = abs(dot(point, tube.xy)) * tube.z, rest = 4.0 - tube.z * tube.z;
    radius = max(radius, (2.0 * across + sqrt(4.0 * across * across + 4.0 * rest * dot(point, point))) / rest);
  }
  return radius;
}

/// Part of the iris's area that the tube leaves.
float open_part(float hidden) {
  float x = 0.5 * hidden, x2 = x * x;
  return 1.0 - 1.27323954 * x * (1.0 - x2 * (1.0 / 6.0 + x2 * (1.0 / 40.0 + x2 * (1.0 / 112.0))));
}

/// A disc at a distance from its middle. Its rim is `soft` wide, so that steps between texels do not show.
float disc(float radius, float away, float soft) { return clamp((radius - away) / soft + 0.5, 0.0, 1.0); }

/// Its area in pixels.
float disc_area(float radius, float soft) { return 3.14159265 * radius * radius + 0.261799388 * soft * soft; }

/// Level of the pyramid that is read for a circle, so that a pixel takes no more than about `samples` texels, a quarter of those in the circle.
int level_for(float radius, float samples) {
  float texels = 0.785398163 * radius * radius;
  return texels > 4.0 * samples ? 2 : texels > samples ? 1 : 0;
}

/// Radius of what the small picture's means make as wide as `radius` was: variances add up, r²/4 of a disc and 1/12 of a square's side².
float before_means(float radius) { return sqrt(max(radius * radius - 4.0 / 3.0, 0.0)); }

/// Where a level lies in the pyramid, and its last texel.
ivec2 origin_of(ivec2 small, int level) { return ivec2(level > 0 ? small.x : 0, level > 1 ? (small.y + 1) >> 1 : 0); }
ivec2 last_texel(ivec2 small, int level) { return ((small + (1 << level) - 1) >> level) - 1; }

/// The first and last row of a level that a pixel reads, for discs that reach so far. Each of 2×2 neighbours has other rows and columns.
/// The light of a texel may lie anywhere in it.
ivec2 rows_of(ivec2 pixel, float reach, int level) {
  ivec2 rows = (ivec2(pixel.y) + ivec2(-1, 1) * int(reach + float((1 << level) - 1))) >> level;
  return ivec2(rows.x + ((pixel.x + pixel.y - rows.x) & 1), rows.y);
}

/// The first and last column in a row whose texels' centres lie `away` pixels from the pixel; `stretch`: of the iris, across and down.
ivec2 columns_of(ivec2 pixel, float reach, float away, vec2 stretch, int level) {
  float spread = float((1 << level) - 1), down = max(abs(away) - 0.5 * spread, 0.0) * stretch.y;
  ivec2 columns = (ivec2(pixel.x) + ivec2(-1, 1) * int(sqrt(max(reach * reach - down * down, 0.0)) / stretch.x + spread)) >> level;
  return ivec2(columns.x + ((pixel.y - columns.x) & 1), columns.y);
}
