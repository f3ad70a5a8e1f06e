// SPDX-License-Identifier: MIT
// Passes of SPIRV-Tools over a module that is taken apart.
#pragma once

#include <cstdint>
#include <optional>
#include <spirv-tools/optimizer.hpp>
#include <string_view>

#include "core/result.h"
#include "shader/spirv_module.h"

namespace afterglow {

/// What it has to say of a module is for nobody.
void be_quiet(spvtools::Optimizer& optimizer);

/// One that says nothing, with the passes that inline all functions and turn variables of every scope into values, as
/// far as single writes go. Callers add what they need behind them.
void add_inlining_passes(spvtools::Optimizer& optimizer);

/// The function that GLSL names so, or 0. (glslang adds the types of its parameters: "ag_stages(vf4;vf4;".)
std::uint32_t function_named(const Module& module, std::string_view name);

/// The inlining passes leave its calls as they are.
void forbid_inlining(Module& module, std::uint32_t function);

/// SPIRV-Tools takes time as the square of the calls that become part of one function: two seconds for so many. (The
/// effects that come along have 664 at most.)
inline constexpr std::uint64_t kMaxInlinedCalls = 1024;

/// Of OpExtInst: a function of GLSL.std.450 that makes a value and does nothing else. Modf and Frexp write to a
/// variable.
bool is_pure_function(const Instruction& function);

/// False: the inlining passes would take too long for this module.
bool inlines_quickly(const Module& module);

/// And as the variables of a function times its blocks (SSARewritePass): a second for so many.
inline constexpr std::uint64_t kMaxVariablesTimesBlocks = 1 << 17;

/// False: turning the variables of this module into values would take too long.
bool rewrites_quickly(const Module& module);

/// Nothing when a pass fails.
std::optional<Module> run_passes(const spvtools::Optimizer& optimizer, const Module& module);

/// Every index is held within its array, vector or matrix, as robustBufferAccess says of buffers: what lies beyond
/// differs between ways of execution, and a driver for CPUs takes it from the memory of the process. Errors: other (no
/// module of GLSL's memory model).
Result<Words> with_held_indices(const Words& spirv);

/// Behind the inlining passes, once unused pointers have gone: values in place of variables, straight code in place of
/// loops of a few turns, which are marked in `inlined`, the module to be run.
void add_rewriting_passes(spvtools::Optimizer& optimizer, Module& inlined);

/// Values in place of functions, their arguments and variables, straight code in place of loops of a few turns, and
/// blocks without those that are never entered.
/// Nothing when that would take too long, or a pass fails.
std::optional<Module> without_variables(const Module& module);

}  // namespace afterglow
