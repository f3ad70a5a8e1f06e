// SPDX-License-Identifier: MIT
// The picture through the fog. z is the distance along the viewing axis; the ray through a pixel is (x, y, 1) · z.
#include "lib/color.glsl"
#include "lib/depth.glsl"

layout(constant_id = 0) const bool device_input = false;
layout(constant_id = 1) const bool reversed_z = true;
layout(constant_id = 2) const bool layered = false;  // thins with height
layout(constant_id = 3) const bool blur = false;     // `scattered` is a blur of the picture; else it is not looked at
layout(constant_id = 4) const bool sunny = false;

uniform vec2 inverse_clip;
uniform float density;  // at the camera's height
uniform float start, most, sky, scattering, ambient, falloff, focus;
uniform vec3 fog, sun_color;
uniform vec3 sun;   // direction of the light, (right, up, ahead)
uniform vec2 view;  // tangents of the picture's half angles
uniform vec2 up;    // what (y, 1) climb

const float kFar = 1e9;

// (1 − e^−u)/u: the mean of e^(−t) for t from 0 to u.
float mean_of_fall(float u) {
  u = clamp(u, -60.0, 1e30);
  return abs(u) < 0.05 ? 1.0 + u * (-0.5 + u * (1.0 / 6.0 + u * (-1.0 / 24.0 + u * (1.0 / 120.0)))) : (1.0 - exp(-u)) / u;
}

vec4 apply(vec4 color, vec4 depth, vec4 scattered, ivec2 pixel) {
  vec2 size = vec2(target_size());
  vec3 ray = vec3((vec2(pixel * 2 + 1) / size - 1.0) * vec2(view.x, -view.y), 1.0);
  float z = device_input ? view_distance(depth.r, inverse_clip, reversed_z) : depth.r;
  z = clamp(z, 0.0, 1e15);
  float along = length(ray), through = max(z * along - start, 0.0);
  float thick = density * through;
  if (layered) {
    float climb = (ray.y * up.x + up.y) / along;  // metres up for each metre of the ray
    float before = clamp(-falloff * climb * min(start, z * along), -80.0, 60.0);
    thick *= exp(before) * mean_of_fall(falloff * climb * through);
  }
  thick = min(thick, 100.0);
  float hidden = thick * mean_of_fall(thick) * most * (z >= kFar ? sky : 1.0);
  vec3 air = fog;
  if (sunny) air = lerp(fog, sun_color, pow(max(dot(ray / along, sun), 0.0), focus));
  air = clamp(air * color.a, -kMaxLight, kMaxLight);
  if (blur) air = lerp(air, scattered.rgb, ambient);
  vec3 seen = blur ? lerp(color.rgb, scattered.rgb, hidden * scattering) : color.rgb;
  return vec4(lerp(seen, air, hidden), color.a);
}
