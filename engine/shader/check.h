// SPDX-License-Identifier: MIT
// Validates one shader by itself, with no device: what `afterglow check` does for every shader of a preset.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "shader/kernel.h"

namespace afterglow {

/// Compiles a kernel of this shader alone (own-pixel or sample anchor). Cheap when the compiler has it cached.
/// Thread-safe. Errors (script): as KernelCompiler::compile.
Result<void> check_shader(KernelCompiler& compiler, std::shared_ptr<const ShaderSource> shader,
                          const std::map<std::string, double>& constants = {});

}  // namespace afterglow
