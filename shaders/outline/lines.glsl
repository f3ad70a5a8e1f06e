// SPDX-License-Identifier: MIT
// How strongly a line is drawn at each pixel, 0…1, from differences of depth, of normals, or of both.
// One-sided differences to the right and below: a line sits on the left or upper pixel of an edge. Differences are taken before they
// are scaled, so that far surfaces keep their digits.
#include "lib/depth.glsl"

layout(constant_id = 0) const bool use_depth = false;    // compare depth
layout(constant_id = 1) const bool use_normal = false;   // compare normals
layout(constant_id = 2) const bool derivative = false;   // one value for each even 2×2 quad; else the neighbours at `width`
layout(constant_id = 3) const bool fade = false;         // width shrinks with distance (needs depth)
layout(constant_id = 4) const bool device_input = false; // `depth` holds device depth
layout(constant_id = 5) const bool reversed_z = true;    // device depth 1 is the near plane
layout(constant_id = 6) const bool raw_depth = false;    // compare device depth as it is, not made linear
layout(constant_id = 7) const bool combine_max = false;  // the stronger of the two; else weighted
layout(constant_id = 8) const bool level_slopes = false; // planes draw no line, however steep
layout(constant_id = 9) const bool preview = false;      // `scale` is below 1
layout(constant_id = 10) const bool next_door = false;   // no pixel is compared with others than its neighbours

uniform sampler2D depth;   // what is not used may be any image: it is never read
uniform sampler2D normal;
uniform vec2 inverse_clip;    // 1/near, 1/far
uniform float width;          // pixels of the delivered picture
uniform float scale;          // pixels for each of those; 1 but in previews
uniform float fade_distance;
uniform float depth_scale, normal_scale;  // ≥ 0
uniform float normal_factor;
uniform float divide_factor;
uniform float contrast;

const float kMaxEdge = 1e30;  // whatever the scales are, sums and weights stay finite

float depth_at(ivec2 pixel) { return fetch(depth, pixel).r; }

float distance_of(float device_depth) { return view_distance(device_depth, inverse_clip, reversed_z); }

// |z(a) − z(b)|; between device depths by 1/u − 1/v = (v − u)/(uv).
float depth_change(float a, float b) {
  float change = abs(a - b);
  if (device_input && !raw_depth)
    change = change * abs(inverse_clip.x - inverse_clip.y) * distance_of(a) * distance_of(b);
  return min(change * depth_scale, kMaxEdge);
}

// The bound keeps the length finite; unit normals differ by at most 2.
float normal_change(vec3 a, vec3 b) {
  vec3 change = a - b;
  return min(sqrt(min(dot(change, change), kMaxEdge)) * normal_scale, kMaxEdge);
}

// How much farther or nearer the pixel ahead is than the plane through the pixel and the one behind it. Along a line on the screen the inverse
// distance of a plane is linear, so its change ahead is that behind; in distances: |z − z₋|·z₊/z₋. Where nothing lies behind, the plane is that
// through the two pixels ahead. `shared_reads`: both are read, at places that the pixels of a column share.
float change_from_plane(float z, ivec2 centre, ivec2 way, bool shared_reads) {
  ivec2 behind = centre - way, further = centre + 2 * way;
  bool inside = min(behind.x, behind.y) >= 0;
  float next = depth_at(centre + way), first;
  if (shared_reads) {
    float before = depth_at(behind), after = depth_at(further);
    first = inside ? before : after;
  } else {
    first = depth_at(inside ? behind : further);
  }
  float middle = inside ? z : next, last = inside ? next : z;  // three depths in a line, from whichever end
  float change = depth_change(middle, last), slope = depth_change(first, middle);
  if (!raw_depth) {
    float from = device_input ? distance_of(first) : first, to = device_input ? distance_of(last) : last;
    slope = min(slope * (max(to, 1e-6) / max(from, 1e-6)), kMaxEdge);
  }
  return (last > middle) == (middle > first) ? max(change - slope, 0.0) : change;
}

int reach(float z) {
  float w = width;
  if (fade) w *= clamp(1.0 - (device_input ? distance_of(z) : z) / fade_distance, 0.0, 1.0);
  return int(floor(w + 0.5));
}

vec4 sample_at(ivec2 pixel) {
  ivec2 centre = derivative ? (pixel / 2) * 2 : pixel;
  float z = fade || use_depth ? depth_at(centre) : 0.0;
  // Where lines are thinner than a preview's pixels, these show so much less of them.
  float thick = derivative ? scale : float(reach(z)) * scale;
  int apart = derivative || next_door ? 1 : thick > 0.0 ? max(int(floor(thick + 0.5)), 1) : 0;
  float covered = min(thick, 1.0);
  ivec2 to_right = ivec2(apart, 0), to_below = ivec2(0, apart);

  // Where a preview's pixels lie farther apart than those of the picture, a slope, which goes on behind, counts as far as it reaches between
  // these; an edge does not go on and counts whole.
  float depth_edge = 0.0, normal_edge = 0.0;
  if (use_depth && level_slopes) {
    depth_edge = change_from_plane(z, centre, to_right, false) + change_from_plane(z, centre, to_below, next_door);
  } else if (use_depth) {
    float across = depth_change(z, depth_at(centre + to_right)), down = depth_change(z, depth_at(centre + to_below));
    if (preview) {
      across -= (1.0 - scale) * min(across, depth_change(z, depth_at(centre - to_right)));
      down -= (1.0 - scale) * min(down, depth_change(z, depth_at(centre - to_below)));
    }
    depth_edge = across + down;
  }
  if (use_normal) {
    vec3 n = fetch(normal, centre).xyz;
    float across = normal_change(n, fetch(normal, centre + to_right).xyz), down = normal_change(n, fetch(normal, centre + to_below).xyz);
    if (preview) {
      across -= (1.0 - scale) * min(across, normal_change(n, fetch(normal, centre - to_right).xyz));
      down -= (1.0 - scale) * min(down, normal_change(n, fetch(normal, centre - to_below).xyz));
    }
    normal_edge = across + down;
  }

  float edge = use_depth ? depth_edge : normal_edge;
  if (use_depth && use_normal)
    edge = combine_max ? max(depth_edge, normal_edge) : normal_factor * normal_edge + (1.0 - normal_factor) * depth_edge;
  edge = min(edge / divide_factor, kMaxEdge);
  if (next_door && thick <= 0.0) edge = 0.0;  // compared with itself
  float line = clamp((edge - 0.5) * contrast + 0.5, 0.0, 1.0);
  return vec4(preview ? line * covered : line);
}
