// SPDX-License-Identifier: MIT
// Where in a texel of the two coarse levels its light lies, from its centre, in pixels of the small picture: a disc stands around its light, not around
// texels, over which it would move in steps. Both levels lie below each other, as in the pyramid.
#include "lib/circle_of_confusion.glsl"
#include "lib/color.glsl"
#include "lib/iris.glsl"

uniform sampler2D source;  // pyramid of the small picture, circles in alpha
uniform ivec2 small;       // size of the small picture

/// The four texels of the next finer level, and their circles.
struct Four {
  vec4 light, circles;
};

Four four_of(ivec2 texel, int level) {
  ivec2 origin = origin_of(small, level - 1), last = last_texel(small, level - 1), first = 2 * texel;
  vec4 a = fetch(source, origin + clamp(first, ivec2(0), last)), b = fetch(source, origin + clamp(first + ivec2(1, 0), ivec2(0), last));
  vec4 c = fetch(source, origin + clamp(first + ivec2(0, 1), ivec2(0), last)), d = fetch(source, origin + clamp(first + 1, ivec2(0), last));
  return Four(max(vec4(luminance(a.rgb), luminance(b.rgb), luminance(c.rgb), luminance(d.rgb)), 0.0) + 1e-6, vec4(a.a, b.a, c.a, d.a));
}

/// How much of a texel's light each of the four has.
vec4 shares_of(ivec2 texel, int level) {
  Four four = four_of(texel, level);
  vec4 light = four.light * like_widest(four.circles, widest_of(four.circles), 0.5);
  return light / (light.x + light.y + light.z + light.w);
}

vec2 middle(vec4 shares) { return vec2(shares.y + shares.w - shares.x - shares.z, shares.z + shares.w - shares.x - shares.y); }

vec4 sample_at(ivec2 pixel) {
  int below = pixel.y - ((small.y + 1) >> 1);
  if (below < 0) return vec4(0.5 * middle(shares_of(pixel, 1)), 0.0, 0.0);
  ivec2 texel = ivec2(pixel.x, below), last = last_texel(small, 1);
  vec4 shares = shares_of(texel, 2);
  vec2 sum = middle(shares);  // of the four, which lie a pixel off
  for (int i = 0; i < 4; ++i)
    sum += 0.5 * shares[i] * middle(shares_of(clamp(2 * texel + ivec2(i & 1, i >> 1), ivec2(0), last), 1));
  return vec4(sum, 0.0, 0.0);
}
