// SPDX-License-Identifier: MIT
// Effects that are added to a preset's stack, taken out, copied and moved in its text: with its comments, layout and
// everything else kept byte for byte. Nothing comes out unless the new text, run, is the wanted stack and no other.
// What a script computes stays as it is, and is refused with its place.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "script/preset.h"

namespace afterglow {

/// One wanted change of a stack.
struct StackEdit {
  enum class Kind {
    add,        ///< an effect, with its defaults, where its injection point and order put it
    remove,     ///< an entry, with the members of a group
    duplicate,  ///< an entry, right behind itself
    earlier,    ///< an entry, before the one that runs before it, within its injection point and its group
    later,      ///< the other way
    mask,       ///< an entry gets the mask `mask`, or none
  };
  Kind kind = Kind::add;
  std::string name;       ///< of the effect that is added, else of the entry: "glow#2"
  std::string mask = {};  ///< of Kind::mask: "luma"; empty: none
};

struct StackRewrite {
  std::string text;
  std::string entry;  ///< what was added, copied or moved, by its name in the new stack; empty: nothing is left of it
  int line = 0;       ///< of that entry
  /// Names of entries before and now, of all that are still there.
  std::vector<std::pair<std::string, std::string>> renamed;
};

/// Pure text and scripts: no file is written. `before` is the text of `file`, which other scripts and effects are found
/// beside. `options`: as the preset is loaded; its overrides and text are ignored. Takes some loads of the preset; not
/// for the drawing thread. Errors (usage): unknown entries, effects and masks; nothing lies in that direction. Errors
/// (script): what stands in the way, with its place.
Result<StackRewrite> rewrite_stack(const std::filesystem::path& file, const std::string& before, const StackEdit& edit,
                                   const PresetOptions& options);

}  // namespace afterglow
