// SPDX-License-Identifier: MIT
// Passes of SPIRV-Tools over a module that is taken apart.
#pragma once

#include <cstdint>
#include <optional>
#include <spirv-tools/optimizer.hpp>

#include "shader/spirv_module.h"

namespace afterglow {

/// One that says nothing, with the passes that inline all functions and turn variables of every scope into values, as
/// far as single writes go. Callers add what they need behind them.
void add_inlining_passes(spvtools::Optimizer& optimizer);

/// SPIRV-Tools takes time as the square of the calls that become part of one function: half a second for so many.
inline constexpr std::uint64_t kMaxInlinedCalls = 512;

/// False: the inlining passes would take too long for this module.
bool inlines_quickly(const Module& module);

/// Nothing when a pass fails.
std::optional<Module> run_passes(const spvtools::Optimizer& optimizer, const Module& module);

}  // namespace afterglow
