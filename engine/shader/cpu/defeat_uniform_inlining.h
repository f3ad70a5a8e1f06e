// SPDX-License-Identifier: MIT
// Values that are the same for a whole draw, made to look as if each pixel had its own. Internal to the room.
//
// lavapipe compiles a fragment shader again, at every draw, for the values that parameters have just then, where that
// makes half of the shader or a loop's end known; and keeps what it compiled until the device goes. (Mesa 22.3: a frame
// of a gather over 96 places then takes 26 ms more, and 1 MB that stays.) It can do so only with conditions that depend
// on nothing else. And what it divides by a zero that it knows (x/0.0, x/(y − y)) is whatever lay in memory, instead of
// an infinity or a NaN, and a zero that it knows divided by anything (0.0/x, (y − y)/x) is 0: divisors and dividends
// are hidden likewise.
#pragma once

#include <cstdint>
#include <vector>

namespace afterglow {

/// Adds bits that are 0, but that only a run can tell, to every number read from the uniform block and the push
/// constants, and to divisors and dividends that may be 0. Results are the same bits, or IEEE's where there were none.
/// A module that is not as expected is left as it is.
std::vector<std::uint32_t> defeat_uniform_inlining(const std::vector<std::uint32_t>& spirv);

}  // namespace afterglow
