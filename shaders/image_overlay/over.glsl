// SPDX-License-Identifier: MIT
// Lays a picture over the picture, with its upper left corner at `corner`, `extent` pixels large (math.md §56).
#include "lib/blend.glsl"

uniform sampler2D over;
uniform ivec2 corner;
uniform ivec2 extent;
uniform float intensity;
layout(constant_id = 0) const int blend = 0;
layout(constant_id = 1) const bool tile = false;
layout(constant_id = 2) const bool larger = false;

ivec2 wrapped(ivec2 at, ivec2 n) {
  ivec2 rest = at % n;
  return rest + n * ivec2(lessThan(rest, ivec2(0)));
}

vec4 texel(ivec2 at) {
  return fetch(over, tile ? wrapped(at, image_size(over)) : at);
}

// Catmull and Rom's cubic: weights of the texels -1, 0, 1, 2 at `t` behind texel 0.
vec4 cubic(float t) {
  float s = 1.0 - t;
  return vec4(-0.5 * t * s * s, 1.0 + t * t * (1.5 * t - 2.5), 1.0 + s * s * (1.5 * s - 2.5), -0.5 * s * t * t);
}

// Between texels, and never beyond what the sixteen around the place have: no dark rings around letters.
vec4 between(vec2 place) {
  ivec2 base = ivec2(floor(place));
  vec4 wx = cubic(place.x - float(base.x)), wy = cubic(place.y - float(base.y));
  vec4 sum = vec4(0.0), least = texel(base), most = least;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      vec4 read = texel(base + ivec2(x - 1, y - 1));
      sum += wx[x] * wy[y] * read;
      least = min(least, read);
      most = max(most, read);
    }
  return clamp(sum, least, most);
}

vec4 texel_of(ivec2 at) {
  return larger ? between((vec2(at) + 0.5) * vec2(image_size(over)) / vec2(extent) - 0.5) : texel(at);
}

vec4 apply(vec4 color, ivec2 pixel) {
  ivec2 at = pixel - corner;
  if (tile) at = wrapped(at, extent);
  if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent))) return color;
  vec4 above = texel_of(at);
  vec3 light = min(above.rgb * intensity, kMaxLight);
  vec3 c;
  if (blend == kBlendNormal) {
    c = light + color.rgb * (1.0 - above.a);
  } else if (blend == kBlendAdd) {
    c = color.rgb + light;
  } else {
    float cover = cover_of(color.a);
    vec3 made = blended(color.rgb / cover, light / cover_of(above.a), blend) * cover;
    c = mix(color.rgb, min(made, kMaxLight), above.a);
  }
  return vec4(clamp(c, -kMaxLight, kMaxLight), color.a);
}
