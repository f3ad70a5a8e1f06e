// SPDX-License-Identifier: MIT
// Half the size again, as `small` does it: of four the widest circle counts, and the light of those whose circles are like it.
uniform sampler2D source;

vec4 sample_at(ivec2 pixel) {
  vec4 a = fetch(source, 2 * pixel), b = fetch(source, 2 * pixel + ivec2(1, 0)), c = fetch(source, 2 * pixel + ivec2(0, 1)), d = fetch(source, 2 * pixel + 1);
  float low = min(min(a.a, b.a), min(c.a, d.a)), high = max(max(a.a, b.a), max(c.a, d.a));
  float widest = -low >= high ? low : high, scale = 2.0 / max(abs(widest), 0.5);
  vec4 weights = clamp(1.5 - scale * abs(vec4(a.a, b.a, c.a, d.a) - widest), 0.0, 1.0);
  return vec4((a.rgb * weights.x + b.rgb * weights.y + c.rgb * weights.z + d.rgb * weights.w) / (weights.x + weights.y + weights.z + weights.w), widest);
}
