// SPDX-License-Identifier: MIT
// Which of the variables that begin without a value are used so. Internal to the room.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "shader/spirv_module.h"

namespace afterglow {

/// `unset`: input → number of the variable that begins with its value. Returns the numbers of those of which a part is
/// used for more than to be carried along, in order. All branches that depend on more than constants count as taken.
/// Nothing when following them would take too long: a word too few is better than one that is wrong.
std::vector<std::uint32_t> unset_uses(const Module& module, const std::map<std::uint32_t, std::uint32_t>& unset);

}  // namespace afterglow
