// SPDX-License-Identifier: MIT
// What a pixel of the glass shows: the three nearest lines, the stripe of phosphor, the spread light.
#include "lib/color.glsl"

uniform sampler2D source;   // a texel for each place of a line
uniform sampler2D picture;  // as it was
uniform sampler2D spread;
layout(constant_id = 0) const int texels = 2;  // texels of a line to both sides that a spot covers
uniform float soft, cut, dark, mask, triad, bend, corner, edge, falloff, glow, apart, brightness, intensity;

// How much of a pixel's width lies in the stripe that begins at `from` of each triad and is a third of it wide, 0…1.
float stripe(float x, float from) {
  vec2 ends = vec2(x, x + 1.0) / triad - from;
  vec2 covered = floor(ends) / 3.0 + min(fract(ends), 1.0 / 3.0);
  return (covered.y - covered.x) * triad;
}

// Light of one channel in line `y` at x, both in texels of the signal: a Gaussian spot, lowered to 0 where it ends, so
// that no texel comes or goes at once.
float beam(float x, int y, int channel) {
  float middle = floor(x);
  float sum = 0.0, weights = 0.0;
  for (int i = -texels; i <= texels; ++i) {
    float d = (middle + float(i) + 0.5 - x) / soft;
    float w = max(exp(-0.5 * d * d) - cut, 0.0);
    sum += w * clamp(fetch(source, ivec2(int(middle) + i, y))[channel], 0.0, 1.0);
    weights += w;
  }
  return sum / max(weights, 1e-20);
}

// Light at d lines from a line's middle: a Gaussian, lowered to 0 at 1.5, where the next line begins to count. Its mean
// is 1: √(2π)σ erf(1.5/(√2σ)) − 3 end, where 1 − erf is 0.243 end for all σ that count.
float across_line(float d, float sigma) {
  float k = -0.5 / (sigma * sigma);
  float end = exp(2.25 * k);
  return max(exp(d * d * k) - end, 0.0) / (2.50662827 * sigma * (1.0 - 0.243 * end) - 3.0 * end);
}

vec4 sample_at(ivec2 pixel) {
  vec2 size = vec2(target_size()), signal = vec2(image_size(source));
  vec2 p = vec2(pixel * 2 + 1) / size - 1.0;  // −1…1
  p *= 1.0 + bend * vec2(p.y * p.y, p.x * p.x) * vec2(0.5, 0.7);
  float aspect = size.x / size.y;
  // Distance from the rounded edge, in shares of half the height; inside below 0.
  vec2 from_corner = abs(p) * vec2(aspect, 1.0) - (vec2(aspect, 1.0) - 2.0 * corner);
  float outside = length(max(from_corner, 0.0)) + min(max(from_corner.x, from_corner.y), 0.0) - 2.0 * corner;
  vec4 before = fetch(picture, pixel);
  float shown = clamp(0.5 - outside / (2.0 * edge), 0.0, 1.0);
  if (shown <= 0.0) return vec4(before.rgb * (1.0 - intensity), before.a);

  vec2 at = (p * 0.5 + 0.5) * signal;
  int line = int(floor(at.y));
  vec3 light = vec3(0.0);
  for (int c = 0; c < 3; ++c) {
    float x = at.x + (float(c) - 1.0) * apart;
    float even = 0.0, sharp = 0.0;
    for (int i = -1; i <= 1; ++i) {
      float v = beam(x, line + i, c);
      // Spots are narrow in the darks and as wide as a line in white; √(2π)σ normalises them.
      float sigma = 0.25 + 0.25 * sqrt(v);
      float d = float(line + i) + 0.5 - at.y;
      sharp += v * across_line(d, sigma);
      even += v * max(0.0, 1.0 - abs(d));  // without scan lines: linear between lines
    }
    light[c] = even + (sharp - even) * dark;
  }
  vec3 around = clamp(fetch_linear(spread, at / signal * vec2(image_size(spread))).rgb, 0.0, 1.0);
  light = light * (1.0 - glow) + around * glow;

  // Three times the light in its own stripe, none in the others: so the mean stays. Bright light floods its neighbours.
  vec3 stripes = vec3(stripe(float(pixel.x), 0.0), stripe(float(pixel.x), 1.0 / 3.0), stripe(float(pixel.x), 2.0 / 3.0));
  light *= 1.0 + mask * (1.0 - clamp(light, 0.0, 1.0)) * (3.0 * stripes - 1.0);
  float lost = falloff * clamp(0.5 * dot(p, p), 0.0, 1.0);
  return vec4(lerp(before.rgb, light * (brightness * (1.0 - lost) * shown), intensity), before.a);
}
