// SPDX-License-Identifier: MIT
// What the compiler takes and devices need not: abilities that are not switched on, barriers that only some invocations
// come to. Internal to the room.
#pragma once

#include <cstdint>
#include <vector>

#include "core/result.h"
#include "shader/glsl.h"
#include "shader/kernel.h"

namespace afterglow {

/// `spirv` is what the compiler made of `assembled`. Errors (script): with file and line, where the compiler knows it.
Result<void> check_usable(const std::vector<std::uint32_t>& spirv, const AssembledKernel& assembled, GlslStage stage);

}  // namespace afterglow
