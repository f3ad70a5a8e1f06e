// SPDX-License-Identifier: MIT
// The present and the past of each pixel; alpha 1 tells the next frame that there was one.
#include "lib/color.glsl"

layout(constant_id = 0) const bool has_depth = false;

uniform sampler2D source;
uniform sampler2D before;
uniform sampler2D motion;
uniform sampler2D depth;
uniform vec2 scale;
uniform float feedback, bounds;

// Colours are weighed by 1/(1 + brightness), so that single bright pixels don't flicker, and looked at as luma and two differences of colour.
vec3 held(vec3 c) {
  c = min(c, vec3(kMaxLight));
  return c / (1.0 + brightest(c));
}
vec3 freed(vec3 c) { return c / max(1.0 - brightest(c), 1e-6); }
vec3 to_ycocg(vec3 c) { return vec3(0.25 * c.r + 0.5 * c.g + 0.25 * c.b, 0.5 * c.r - 0.5 * c.b, -0.25 * c.r + 0.5 * c.g - 0.25 * c.b); }
vec3 from_ycocg(vec3 c) { return vec3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z); }

vec4 catmull_rom(float t) {
  return vec4(((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0, ((-1.5 * t + 2.0) * t + 0.5) * t, (0.5 * t - 0.5) * t * t);
}

vec3 past_at(vec2 at) {
  vec2 base = floor(at - 0.5), f = at - 0.5 - base;
  vec4 wx = catmull_rom(f.x), wy = catmull_rom(f.y);
  vec3 sum = vec3(0.0);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) sum += wx[x] * wy[y] * held(fetch(before, ivec2(base) + ivec2(x, y) - 1).rgb);
  return max(sum, vec3(0.0));
}

vec4 sample_at(ivec2 pixel) {
  vec3 color = fetch(source, pixel).rgb;
  ivec2 nearest = pixel;  // of what is in front: edges move with it
  vec3 sum = vec3(0.0), squares = vec3(0.0), least = vec3(1e30), most = vec3(-1e30);
  float front = has_depth ? fetch(depth, pixel).r : 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = pixel + ivec2(x, y);
      vec3 c = to_ycocg(held(fetch(source, at).rgb));
      sum += c;
      squares += c * c;
      least = min(least, c);
      most = max(most, c);
      float z = has_depth ? fetch(depth, at).r : 0.0;
      if (z < front) {
        front = z;
        nearest = at;
      }
    }
  if (fetch(before, pixel).a == 0.0) return vec4(color, 1.0);
  vec2 way = clamp(fetch(motion, nearest).xy * scale, -32768.0, 32768.0);
  vec2 from = vec2(pixel) + 0.5 + way, size = vec2(target_size());
  if (any(lessThan(from, vec2(0.0))) || any(greaterThan(from, size))) return vec4(color, 1.0);

  vec3 mean = sum / 9.0, deviation = sqrt(max(squares / 9.0 - mean * mean, vec3(0.0)));
  vec3 low = max(mean - bounds * deviation, least), high = min(mean + bounds * deviation, most);
  vec3 middle = 0.5 * (low + high), half_size = max(0.5 * (high - low), vec3(1e-7));
  vec3 past = to_ycocg(past_at(from));
  vec3 off = past - middle, share = abs(off / half_size);
  float beyond = max(share.x, max(share.y, share.z));
  if (beyond > 1.0) past = middle + off / beyond;  // towards the middle, until it is within
  vec3 present = held(color);
  vec3 joined = lerp(present, max(from_ycocg(past), vec3(0.0)), feedback);
  return vec4(min(freed(joined), vec3(kMaxLight)), 1.0);
}
