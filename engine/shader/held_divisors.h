// SPDX-License-Identifier: MIT
// Whole numbers divided by 0, which GLSL leaves to each device. Internal to the room.
#pragma once

#include "shader/spirv_module.h"

namespace afterglow {

/// Divisors of whole numbers that may be 0 are 1 then, as WGSL has it: x / 0 is x, and x % 0 is 0.
Words with_held_divisors(Words spirv);

}  // namespace afterglow
