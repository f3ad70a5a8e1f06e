// SPDX-License-Identifier: MIT
// Rewrites a file's text so that any files can stand in one kernel: every name it defines at file scope gets a prefix
// of its own, uniforms and includes vanish, constants get their values; lines stay where they are. Internal to the
// room.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "shader/cpu/storage_reads.h"
#include "shader/scan.h"

namespace afterglow {

/// Macros are replaced wherever the preprocessor would, other names not where fields stand: behind '.', in a struct, or
/// as an argument that a macro makes a field of.
struct NewName {
  std::string text;
  bool macro = false;
  bool with_arguments = false;             ///< as of GlobalName
  std::vector<bool> field_arguments = {};  ///< as of GlobalName
};

/// What a word of the file becomes.
using NameMap = std::map<std::string, NewName, std::less<>>;

/// `constants[i]` replaces the declaration of parameter i; reads of the inputs in `readers` become calls of their own
/// functions. The variable `scanned.unset[i]` gets a value where it is declared, as number `first_unset` + i (see
/// shader/give_values.h). Ends with a newline.
std::string rewrite(std::string_view text, const ShaderScan& scanned, const NameMap& names,
                    const std::vector<std::string>& constants, std::size_t first_unset,
                    const StorageReaders& readers = {});

/// Removes the prefixes from a compiler's message: "ag_s0_threshold" → "threshold", "ag_r1_fetch" → "fetch".
std::string original_names(std::string_view message);

}  // namespace afterglow
