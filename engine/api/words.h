// SPDX-License-Identifier: MIT
// The engine speaks to users of the command line: its words, as hosts know them.
#pragma once

#include <string>

#include "core/result.h"

namespace afterglow::api {

/// "--set glow.tint: …" is of glow.tint, "(--max-memory)" is max_memory.
std::string for_hosts(std::string message);
Error for_hosts(Error error);

}  // namespace afterglow::api
