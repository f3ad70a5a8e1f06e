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

vec4 sample_at(ivec2 pixel) {
  vec4 color = fetch(source, pixel);
  vec2 size = vec2(target_size());
  vec2 from_centre = (vec2(2 * pixel + 1) - size) / size;  // −1…1
  vec2 way = -from_centre * dot(from_centre, from_centre) * amount * size;
  if (three) {
    vec2 here = vec2(pixel) + 0.5;
    return vec4(color.r, fetch_linear(source, here + 0.5 * way).g, fetch_linear(source, here + way).b, color.a);
  }
  bool flat_way = abs(way.x) >= abs(way.y);
  float signed_length = flat_way ? way.x : way.y, longer = max(abs(signed_length), 1e-6);
  float slope = (flat_way ? way.y : way.x) / longer, step = 1.0 / longer;
  ivec2 across = flat_way ? ivec2(0, 1) : ivec2(1, 0);
  ivec2 along = (1 - across) * (signed_length < 0.0 ? -1 : 1);
  int last = int(ceil(longer));
  vec3 here = spectrum(step), change = here, sum = change * color.rgb;
  for (int i = 1; i <= last; ++i) {
    vec3 next = spectrum(float(i + 1) * step), weight = max((next - here) - change, vec3(0.0));
    if (float(i - 1) * step >= 0.5) weight.r = 0.0;  // red has ended: no rounding of it, which bright pixels would show
    float aside = float(i) * slope, whole = floor(aside), rest = aside - whole;
    ivec2 at = pixel + i * along + int(whole) * across;
    sum += weight * ((1.0 - rest) * fetch(source, at).rgb + rest * fetch(source, at + across).rgb);
    change = next - here;
    here = next;
  }
  // All weights together are what the last change is.
  return vec4(max(sum / change, 0.0), color.a);
}
