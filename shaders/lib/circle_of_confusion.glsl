// SPDX-License-Identifier: MIT
// Circles of confusion: how wide a lens draws a point that is not in its focus.
/// Radius of the circle of confusion of what lies at distance z, in pixels: below 0 in front of the focus, above 0 behind it. `focus` is its
/// distance, the radius for what is infinitely far, and the widest radius.
float circle_of(float z, vec3 focus) { return clamp(focus.y * (z - focus.x) / max(z, 1e-6), -focus.z, focus.z); }

/// `focus` for something at 1/distance `dioptres`: `lens` is the focal length in m, the radius in pixels for what is infinitely far where the focus lies
/// a metre behind it, and the widest radius. Nearer than the focal length nothing is ever sharp.
vec3 focus_at(float dioptres, vec3 lens) {
  float d = max(1.0 / max(dioptres, 1e-6), 1.01 * lens.x);
  return vec3(d, min(lens.y / (d - lens.x), 1e6), lens.z);
}

/// Of four pixels the widest circle; of equal ones that in front.
float widest_of(vec4 circles) {
  float low = min(min(circles.x, circles.y), min(circles.z, circles.w)), high = max(max(circles.x, circles.y), max(circles.z, circles.w));
  return -low >= high ? low : high;
}

/// How much four pixels count in the mean of those whose circles are like `widest`, which counts as at least `least` wide.
vec4 like_widest(vec4 circles, float widest, float least) { return clamp(1.5 - abs(circles - widest) * (2.0 / max(abs(widest), least)), 0.0, 1.0); }
