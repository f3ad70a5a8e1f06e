// SPDX-License-Identifier: MIT
// The interface: vertex colours times the atlas, which has white glyphs and pictures as sRGB codes.
#version 450

layout(set = 0, binding = 0) uniform sampler2D atlas;
layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 result;

// The target's stores encode: hand over linear values. Known when the pipeline is made, since CPU drivers run through both.
layout(constant_id = 0) const bool kLinear = false;

vec3 decoded(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

void main() {
  vec4 texel = texture(atlas, uv);
  result = color * (kLinear ? vec4(decoded(texel.rgb), texel.a) : texel);
}
