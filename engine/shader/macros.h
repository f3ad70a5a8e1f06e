// SPDX-License-Identifier: MIT
// Bounds what the preprocessor makes of a shader before the compiler sees it: forty short #define lines can double
// forty times. Internal to the room.
#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "shader/scan.h"

namespace afterglow {

inline constexpr double kMaxExpandedTokens = 16384;  ///< of one statement, or one preprocessor condition
inline constexpr int kMaxMacroDepth = 64;            ///< macros that use macros

/// One file of a shader: an include, or (last) the shader itself.
struct MacroFile {
  std::string file;
  const ShaderScan* scanned = nullptr;
  std::vector<std::size_t> uses;  ///< indices of the files whose macros it sees
};

/// Errors (script): a statement that grows beyond the limits; macros used in ways that keep their growth from being
/// known (unbalanced brackets in a macro, the name of a macro with arguments where arguments may come behind it).
Result<void> check_macros(const std::vector<MacroFile>& files);

}  // namespace afterglow
