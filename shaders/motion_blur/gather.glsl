// SPDX-License-Identifier: MIT
// Mean along the longest motion around, over whole pixels. Each read counts for what it covers of the pixel while the shutter is open.
#include "lib/color.glsl"
#include "lib/noise.glsl"

layout(constant_id = 0) const bool has_depth = false;

uniform sampler2D source;   // half ways and depths
uniform sampler2D picture;
uniform sampler2D longest;  // half ways, by tile
uniform int block;
uniform int samples;
uniform float softness;

/// How much of the way's length reaches as far as `away`: falls to 0 at its end.
float cone(float away, float way) { return clamp(1.0 - away / way, 0.0, 1.0); }

/// 1 within the way, 0 beyond.
float cylinder(float away, float way) { return 1.0 - smoothstep(0.95 * way, 1.05 * way, away); }

/// 1 when a is in front of b, or not much behind it.
float in_front(float a, float b) { return has_depth ? clamp(1.0 - (a - b) / softness, 0.0, 1.0) : 1.0; }

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(picture, pixel);
  vec2 way = fetch(longest, pixel / block).xy;
  if (dot(way, way) <= 0.25) return color;  // nothing around moves by a pixel
  vec4 own = fetch(source, pixel);
  float own_way = max(length(own.xy), 0.5);
  // Another offset for each pixel turns steps into fine grain.
  float offset = unit_of(pcg3d(uvec3(pixel, 0))).x - 0.5;
  vec3 mean = color.rgb;
  // No more reads than there are pixels on the way. (0.7: what is rounded decides nothing where motion is in whole or half pixels.)
  int count = min(samples, int(floor(2.0 * length(way) + 0.7)) + 1);
  float weight = float(count) / (float(samples) * own_way);
  for (int i = 0; i < count; ++i) {
    float t = (float(i) + offset + 1.0) / float(count + 1) * 2.0 - 1.0;
    ivec2 at = pixel + ivec2(floor(way * t + 0.5));
    if (at == pixel) continue;
    vec4 read = fetch(source, at);
    float away = length(vec2(at - pixel)), read_way = max(length(read.xy), 0.5);
    float counts = in_front(read.z, own.z) * cone(away, read_way) + in_front(own.z, read.z) * cone(away, own_way) +
                   2.0 * cylinder(away, read_way) * cylinder(away, own_way);
    if (counts <= 0.0) continue;
    weight += counts;
    mean = lerp(mean, fetch(picture, at).rgb, counts / weight);
  }
  return vec4(mean, color.a);
}
