// SPDX-License-Identifier: MIT
// Where the loops of a kernel stand in its authors' files. Internal to the room.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"
#include "shader/glsl.h"

namespace afterglow {

/// Of assembled GLSL: the number of the file and the line of each of `loops`, one behind the other. Those are counted
/// by the OpLoopMerge in what compile_glsl makes of it.
Result<std::vector<std::uint32_t>> loop_places(const std::string& glsl, GlslStage stage,
                                               const std::vector<std::uint32_t>& loops);

}  // namespace afterglow
