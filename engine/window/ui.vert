// SPDX-License-Identifier: MIT
// The interface: triangles in pixels of the window, colours as sRGB codes.
#version 450

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;

layout(push_constant) uniform Push {
  vec2 scale;   // from window coordinates to −1…1
  vec2 shift;
} push;

layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec4 out_color;

layout(constant_id = 0) const bool kLinear = false;  // as in ui.frag

vec3 decoded(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

void main() {
  out_uv = uv;
  out_color = kLinear ? vec4(decoded(color.rgb), color.a) : color;
  gl_Position = vec4(position * push.scale + push.shift, 0.0, 1.0);
}
