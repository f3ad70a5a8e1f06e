// SPDX-License-Identifier: MIT
// The picture through the fog, which hides and leaves `shares` of it.
#include "lib/color.glsl"

layout(constant_id = 0) const bool blur = false;  // `scattered` is a blur of the picture; else it is not looked at
layout(constant_id = 1) const bool sunny = false;

uniform sampler2D shares;  // by its place, so that its own pass leaves out what lies between edges
uniform float scattering, ambient, focus;
uniform vec3 fog, sun_color;
uniform vec3 sun;   // direction of the light, (right, up, ahead)
uniform vec2 view;  // tangents of the picture's half angles

vec4 apply(vec4 color, vec4 scattered, ivec2 pixel) {
  vec2 share = fetch(shares, pixel).rg;
  vec3 air = fog;
  if (sunny) {
    vec3 ray = vec3((vec2(pixel * 2 + 1) / vec2(target_size()) - 1.0) * vec2(view.x, -view.y), 1.0);
    air = lerp(fog, sun_color, pow(max(dot(normalize(ray), sun), 0.0), focus));
  }
  air = clamp(air * color.a, -kMaxLight, kMaxLight);
  if (blur) air = lerp(air, scattered.rgb, ambient);
  vec3 seen = blur ? lerp(color.rgb, scattered.rgb, share.r * scattering) : color.rgb;
  return vec4(air * share.r + seen * share.g, color.a);
}
