// SPDX-License-Identifier: MIT
// Finds barriers that not all invocations of a workgroup come to: what happens there is undefined, from a device that
// is lost to pixels that were never made. Internal to the room.
#pragma once

#include <cstddef>
#include <optional>

#include "shader/spirv_module.h"

namespace afterglow {

/// The index in `module.code` of the first OpControlBarrier, or of the first call of a function that has one, that
/// stands where invocations may have gone different ways: in a branch or loop whose condition is not the same for all
/// of them, or behind a return, break or continue in one. A value is the same for all when it is made of constants,
/// parameters and what is read at places that are the same for all. Of a module as the compiler makes it, before
/// anything else has changed it.
std::optional<std::size_t> divergent_barrier(const Module& module);

}  // namespace afterglow
