// SPDX-License-Identifier: MIT
// Anti-aliased edge pixels, which have the colour of two things, but the depth and the motion of one.
/// Weight of the neighbour at `by` as what stands for an edge pixel; `away` points away from the edge, the longer the more of it there is. Nearly
/// straight away from it alone, so that bright lights are not drawn along the edge.
float away_from(vec2 away, vec2 by) {
  float along = max(dot(by, away), 0.0), length2 = dot(away, away);
  float cos2 = along * along / (max(dot(by, by), 1.0) * max(length2, 1e-6)), cos4 = cos2 * cos2, cos8 = cos4 * cos4;
  return length2 * cos8 * cos8;
}
