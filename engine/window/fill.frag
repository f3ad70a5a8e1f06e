// SPDX-License-Identifier: MIT
// One colour, as it is stored.
#version 450

layout(push_constant) uniform Push { vec4 fill; } push;
layout(location = 0) out vec4 result;

void main() { result = vec4(push.fill.rgb, 1.0); }
