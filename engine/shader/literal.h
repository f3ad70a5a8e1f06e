// SPDX-License-Identifier: MIT
// Literals of GLSL. Internal to the room.
#pragma once

#include <optional>

#include "shader/interface.h"
#include "shader/token.h"

namespace afterglow {

/// The number that a literal says (`0x10`, `010`, `1.5f`, `true`: 1). Nothing where it is none of that type.
std::optional<double> literal_value(const Token& token, ParamType type);

}  // namespace afterglow
