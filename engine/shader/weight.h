// SPDX-License-Identifier: MIT
// What authors' shaders may hold at most. Drivers unfold arrays, copies and calls into single instructions, and take
// minutes, gigabytes or their own death for what stands in a short line; nothing ends a driver. Internal to the room.
#pragma once

#include <cstdint>
#include <vector>

#include "core/result.h"
#include "shader/kernel.h"

namespace afterglow {

// Mesa 22.3's lavapipe takes 0.8 s of a processor for an array of 256 floats and 8 s for one of 1024.
inline constexpr std::uint64_t kMaxVariableBytes = 1024;  ///< one variable, constant or value
inline constexpr std::uint64_t kMaxHeldBytes = 4096;      ///< all arrays of a kernel, once for each call of a function
inline constexpr std::uint64_t kMaxCopiedBytes = 1024;    ///< arrays that are copied whole, once for each call
inline constexpr std::uint64_t kMaxInstructions = 65536;  ///< of a kernel, once for each call
/// Of a kernel that joins passes, which may run apart. LLVM 15 takes 2 s for 12 loops one after another, 8 s for 14 and
/// 40 s for 16, where one's turns depend on pixels.
inline constexpr std::uint64_t kMaxJoinedLoops = 10;
// What a workgroup may share: kMaxSharedBytes of shader/workgroup.h.

/// `spirv` was made of `kernel`, and is counted by row: how many an invocation makes is the engine's affair. Errors
/// (script): a limit, with file and line of the variable or the function.
Result<void> check_weight(const std::vector<std::uint32_t>& spirv, const KernelDesc& kernel);

/// What the invocations of a workgroup share, in bytes.
std::uint64_t shared_bytes(const std::vector<std::uint32_t>& spirv);

}  // namespace afterglow
