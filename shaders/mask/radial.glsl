// SPDX-License-Identifier: MIT
// 1 within an ellipse, 0 beyond `soft` outside of it, in picture heights.
uniform vec2 center;  // in pictures
uniform vec2 radius;  // in picture heights, > 0
uniform float soft;
uniform vec2 turn;    // cosine and sine

vec4 apply(vec4 color, ivec2 pixel) {
  vec2 size = vec2(target_size());
  vec2 d = (vec2(pixel) + 0.5 - center * size) / size.y;
  vec2 e = vec2(turn.x * d.x + turn.y * d.y, turn.x * d.y - turn.y * d.x) / radius;
  float away = (length(e) - 1.0) * min(radius.x, radius.y);
  return vec4(1.0 - smoothstep(0.0, soft, away));
}
