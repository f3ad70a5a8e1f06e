// SPDX-License-Identifier: MIT
// The same as wanted.glsl: a workgroup adds the rows, a column of them each, and goes through the bins.
#include "lib/exposure.glsl"

const int kColumns = kBins / 2, kLanes = 4;

layout(local_size_x = 32, local_size_y = 4, pixels_x = 1, pixels_y = 1) in;

uniform sampler2D rows;
uniform vec2 percentiles;  // 0…1
uniform vec2 limits;       // EV

// Weight and weight·EV of two bins: sums of every fourth row.
shared vec4 parts[kColumns * kLanes];

vec4 compute_at(ivec2 pixel) {
  int column = int(gl_LocalInvocationID.x), lane = int(gl_LocalInvocationID.y), height = image_size(rows).y;
  vec4 sum = vec4(0.0);
  for (int y = lane; y < height; y += kLanes) sum += fetch(rows, ivec2(column, y));
  parts[lane * kColumns + column] = sum;
  barrier();
  if (lane == 0)
    for (int other = 1; other < kLanes; ++other) parts[column] += parts[other * kColumns + column];
  barrier();
  float total = 0.0;
  for (int i = 0; i < kColumns; ++i) total += parts[i].x + parts[i].z;
  Percentiles p = between(percentiles, total);
  for (int i = 0; i < kBins; ++i) add_bin(p, i % 2 == 0 ? parts[i / 2].xy : parts[i / 2].zw);
  return vec4(mean_of(p, limits), 0.0, 0.0, 1.0);
}
