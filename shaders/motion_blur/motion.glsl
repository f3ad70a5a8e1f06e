// SPDX-License-Identifier: MIT
// Half the way that a pixel moves while the shutter is open, held to max_radius (xy), how near it is (z), and by how many times the way was
// longer before (w). Without depth, what moves farther is nearer.
layout(constant_id = 0) const bool has_depth = false;

uniform vec2 scale;
uniform float max_radius;

vec4 apply(vec4 color, vec4 motion, vec4 depth) {
  vec2 way = clamp(motion.xy * scale, -1e9, 1e9);
  float length_of_way = length(way);
  float longer = max(length_of_way / max_radius, 1.0);
  return vec4(way / longer, has_depth ? -depth.r : min(length_of_way, max_radius), min(longer, 6e4 / max_radius));
}
