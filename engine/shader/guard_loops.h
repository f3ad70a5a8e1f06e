// SPDX-License-Identifier: MIT
// Loops that may never end get an end, and tell of it. Internal to the room.
//
// Nothing ends a shader that runs on the CPU: its device is our own process. (Mesa's lavapipe leaves a loop after 65535
// turns of a group of pixels, silently and with wrong pixels; with a long body, or for each of a million pixels, that
// takes hours.) So each invocation has a number of turns for all loops of a pass. The first one that has used them up
// leaves its loops and writes which loop it was into a buffer; invocations that begin later find that and turn no loop
// at all, so that the frame is over at once. Passes of one kernel and rows of one invocation have their turns each.
#pragma once

#include <cstdint>
#include <vector>

namespace afterglow {

/// Turns of an invocation in one pass, of one of its rows. Below what lavapipe allows, so that it is not the driver
/// that ends a loop.
inline constexpr std::uint32_t kMaxTurns = 32768;
/// Loops of constants are left alone up to so many turns, with those inside of them.
inline constexpr std::uint64_t kFewTurns = 4096;

struct LoopsGuarded {
  std::vector<std::uint32_t> spirv;
  bool guarded = false;  ///< it has a storage buffer of one word at `binding` of set 0
};

/// The word is 0, or 1 + the number of the loop, in the order of the module, that ran out of turns. Counting loops cost
/// a few instructions each, others one more step a turn; a module without loops that need it, or one that is not as
/// expected, is left as it is. Results are the same bits. A workgroup leaves loops with barriers together.
LoopsGuarded guard_loops(const std::vector<std::uint32_t>& spirv, std::uint32_t binding);

}  // namespace afterglow
