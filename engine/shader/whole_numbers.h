// SPDX-License-Identifier: MIT
// Whole numbers that are known while a shader is compiled. Internal to the room.
#pragma once

#include <cstddef>

#include "shader/spirv_module.h"

namespace afterglow {

/// Puts constants in place of the 32-bit whole numbers of one function, and of what compares them, where they come of
/// constants and of its own variables and are the same each time. What computed them stays, unused. Numbers that are not whole are left alone:
/// those of this machine may be other bits than the device's. `function`: place of its OpFunction.
void know_whole_numbers(Module& module, std::size_t function);

}  // namespace afterglow
