// SPDX-License-Identifier: MIT
// SPIR-V whose instructions know where they stand in their authors' files. Internal to the room.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"
#include "shader/glsl.h"
#include "shader/spirv_module.h"

namespace afterglow {

struct SourcePlace {
  std::uint32_t file = 0, line = 0;  ///< number of the file in #line, and its line
};

struct LinedModule {
  Module module;
  std::vector<SourcePlace> places;  ///< parallel to `module.code`
};

/// What compile_glsl makes of assembled GLSL, with the OpLine among the code. Errors: as of compile_glsl.
Result<LinedModule> compile_with_lines(const std::string& glsl, GlslStage stage);

}  // namespace afterglow
