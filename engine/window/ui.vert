// SPDX-License-Identifier: MIT
// The interface: triangles in pixels of the window, colours as sRGB codes.
#version 450

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;

layout(push_constant) uniform Push {
  vec2 scale;   // from window coordinates to −1…1
  vec2 shift;
  int linear;   // the target's stores encode: hand over linear values
} push;

layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec4 out_color;
layout(location = 2) flat out int out_linear;

vec3 decoded(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

void main() {
  out_uv = uv;
  out_linear = push.linear;
  out_color = push.linear != 0 ? vec4(decoded(color.rgb), color.a) : color;
  gl_Position = vec4(position * push.scale + push.shift, 0.0, 1.0);
}
