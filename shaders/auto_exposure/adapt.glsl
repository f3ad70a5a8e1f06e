// SPDX-License-Identifier: MIT
// From the exposure value of the frame before towards the wanted one: `speed` stops a second while further than kNear off, then
// exponentially with the same slope at the joint. Exact for any time, so that two short steps are one long one.
uniform float seconds;
uniform vec2 speeds;  // towards brighter and towards darker scenes, stops a second

const float kNear = 1.5;  // stops

vec4 apply(vec4 color, vec4 before) {
  float way = color.r - before.r, speed = way > 0.0 ? speeds.x : speeds.y;
  float off = abs(way), even = min(max(off - kNear, 0.0) / speed, seconds);
  float left = (off - even * speed) * exp((even - seconds) * speed / kNear);
  return vec4(color.r - sign(way) * left, 0.0, 0.0, 1.0);
}
