// SPDX-License-Identifier: MIT
// The text of shaders/lib/prelude.glsl, built into the library. Internal to the room.
#pragma once

#include <string_view>

namespace afterglow {

std::string_view prelude_text();

}  // namespace afterglow
