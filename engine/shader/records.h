// SPDX-License-Identifier: MIT
// Records of GLSL (`struct`). Internal to the room.
#pragma once

#include <cstdint>
#include <span>

#include "shader/token.h"

namespace afterglow {

/// Members that a record has, with those of the records that it is made of; elements of arrays count once. The compiler
/// looks at them one by one, many times: records that double each other 30 times keep it for hours.
inline constexpr std::uint64_t kMostMembers = 1024;

/// The name of the first record of a file that has more; null: none has. Records of other files count as one member.
const Token* record_with_too_many_members(std::span<const Token* const> code);

}  // namespace afterglow
