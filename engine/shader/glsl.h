// SPDX-License-Identifier: MIT
// glslang behind one function. Internal to the room.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

enum class GlslStage { fragment, compute };

/// GLSL 460 → SPIR-V 1.3 for Vulkan 1.1, the oldest that devices may have. The first call in a process takes about 100
/// ms. Thread-safe. Errors (script): the first error of the compiler at its file (`file_names` by the numbers in #line)
/// and line, the others in the trail, names as the author wrote them. `with_lines`: with OpLine, for readers of the
/// SPIR-V.
Result<std::vector<std::uint32_t>> compile_glsl(const std::string& glsl, const std::vector<std::string>& file_names,
                                                GlslStage stage = GlslStage::fragment, bool with_lines = false);

}  // namespace afterglow
