// SPDX-License-Identifier: MIT
// Shaders that ask for smaller levels of an image, as those of games do: images have one. Internal to the room.
#pragma once

#include <optional>
#include <vector>

#include "shader/token.h"

namespace afterglow {

/// The line of the first textureLod or texelFetch whose level, or texture whose bias, is not 0 as it stands there.
std::optional<int> level_line(const std::vector<Token>& tokens);

}  // namespace afterglow
