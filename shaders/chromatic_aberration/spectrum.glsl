// SPDX-License-Identifier: MIT
// The way from a pixel to its end point shows red 1 − 2t, green 1 − |2t − 1|, blue 2t − 1 at t = 0…1. It is read at whole pixels of its longer
// axis, between the two pixels there; each read weighs what the spectrum's integral over its tent is, so that there is no gap at any length.
layout(constant_id = 0) const bool three = false;  // three reads alone: red at its beginning, green in its middle, blue at its end

uniform sampler2D source;
uniform float amount;  // length of the way in pictures, at the middle of a side

// Second integrals of the spectrum from its beginning to t. What falls and what rises from one end to the other of half of it has those of
// c²/2 − c³/3 and c³/3, and goes on with a slope of 1/4.
vec3 spectrum(float t) {
  float a = clamp(t, 0.0, 0.5), b = clamp(t - 0.5, 0.0, 0.5), aa = a * a, bb = b * b;
  float on = 0.25 * max(t - 0.5, 0.0), further = 0.25 * max(t - 1.0, 0.0);
  float rise = aa * a * (1.0 / 3.0), rise_b = bb * b * (1.0 / 3.0);
  return vec3(0.5 * aa - rise + on, rise + on + 0.5 * bb - rise_b + further, rise_b + further);
}

// The way: how far it goes aside with each pixel of its longer axis, that axis, and the other one.
struct Way {
  float slope;
  ivec2 along, across;
};

// Light on the way, i pixels from its beginning.
vec3 light_at(ivec2 pixel, int i, Way way) {
  float aside = float(i) * way.slope, whole = floor(aside), rest = aside - whole;
  ivec2 at = pixel + i * way.along + int(whole) * way.across;
  return (1.0 - rest) * fetch(source, at).rgb + rest * fetch(source, at + way.across).rgb;
}

const int kMost = 2048;  // turns, more than there are

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  vec2 size = vec2(target_size());
  vec2 from_centre = (vec2(2 * pixel + 1) - size) / size;  // −1…1
  vec2 to = -from_centre * dot(from_centre, from_centre) * amount * size;
  if (three) {
    vec2 here = vec2(pixel) + 0.5;
    return vec4(color.r, fetch_linear(source, here + 0.5 * to).g, fetch_linear(source, here + to).b, color.a);
  }
  bool flat_way = abs(to.x) >= abs(to.y);
  float signed_length = flat_way ? to.x : to.y, longer = max(abs(signed_length), 1e-6);
  float step = 1.0 / longer;
  ivec2 across = flat_way ? ivec2(0, 1) : ivec2(1, 0);
  Way way = Way((flat_way ? to.y : to.x) * step, (1 - across) * (signed_length < 0.0 ? -1 : 1), across);
  int last = int(longer);  // it and the pixel behind it are at the end

  // The pixels between the first and the last ones. Where the spectrum is a line over a whole tent, a weight is the line's middle; the bend in
  // the middle of the way adds what the tent has beyond it. In units of 2·step³. All weights together are step/4; those of green, of which the
  // spectrum has twice as much, step/2.
  vec3 sum = vec3(0.0);
  if (last > 1)
    for (int i = 1; i < kMost; ++i) {
      float at = float(i), beyond = at - 0.5 * longer, near = max(1.0 - abs(beyond), 0.0), bend = near * near * near * (1.0 / 6.0);
      sum += vec3(max(-beyond, 0.0) + bend, min(at, longer - at) - 2.0 * bend, max(beyond, 0.0) + bend) * light_at(pixel, i, way);
      if (i + 1 == last) break;
    }
  sum *= vec3(8.0, 4.0, 8.0) * (step * step);

  // Those at the end, seen from there: backwards the spectrum is itself with red and blue changed over, and small integrals keep their digits.
  float rest = longer - float(last);
  vec3 behind = spectrum(rest * step).bgr, end = max(spectrum((1.0 + rest) * step).bgr - 2.0 * behind, 0.0);
  vec3 ends = end * light_at(pixel, last, way) + behind * light_at(pixel, last + 1, way);
  if (last > 0) ends += spectrum(step) * color.rgb;
  return vec4(max(sum + vec3(4.0, 2.0, 4.0) * longer * ends, 0.0), color.a);
}
