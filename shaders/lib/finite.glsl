// SPDX-License-Identifier: MIT
// Which values are finite, told by their bits: comparisons may be reckoned away.

bvec4 not_finite(vec4 value) { return equal(floatBitsToUint(value) & 0x7f800000u, uvec4(0x7f800000u)); }
