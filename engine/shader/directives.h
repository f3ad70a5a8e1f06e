// SPDX-License-Identifier: MIT
// The preprocessor lines of one file: which there may be, and what they say. Internal to the room.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/result.h"
#include "shader/token.h"

namespace afterglow {

/// `#include "name"`.
struct IncludeLine {
  std::string name;
  int line = 0;
};

/// A range of the text that the assembler replaces: uniforms and includes vanish, constants get their value.
struct Edit {
  std::size_t begin = 0, end = 0;  ///< byte offsets
  int constant = -1;               ///< index into ShaderInterface::params of the constant declared here; -1: vanishes
  int unset = -1;                  ///< index into ShaderScan::unset: its value is to be put here
};

struct Directives {
  std::vector<Token> macros;  ///< the names behind #define
  std::vector<IncludeLine> includes;
  std::vector<Edit> edits;  ///< the include lines
};

/// Errors (script): lines that are not allowed, #if without #endif, #undef of what the file has not defined.
Result<Directives> scan_directives(const std::vector<Token>& tokens, const std::string& file);

}  // namespace afterglow
