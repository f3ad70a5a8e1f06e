// SPDX-License-Identifier: MIT
// Passes of SPIRV-Tools over a module that is taken apart.
#pragma once

#include <optional>
#include <spirv-tools/optimizer.hpp>

#include "shader/spirv_module.h"

namespace afterglow {

/// One that says nothing, with the passes that inline all functions and turn variables of every scope into values, as
/// far as single writes go. Callers add what they need behind them.
void add_inlining_passes(spvtools::Optimizer& optimizer);

/// Nothing when a pass fails.
std::optional<Module> run_passes(const spvtools::Optimizer& optimizer, const Module& module);

}  // namespace afterglow
