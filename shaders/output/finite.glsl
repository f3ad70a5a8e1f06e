// SPDX-License-Identifier: MIT
// Behind each pass of a frame that is traced (--nan-policy zero): what is not finite becomes 0.
#include "lib/finite.glsl"

vec4 apply(vec4 color) { return mix(color, vec4(0.0), not_finite(color)); }
