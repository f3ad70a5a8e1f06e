// SPDX-License-Identifier: MIT
// Where the text of a preset speaks of a setting, and what changing it there comes to. Pure text.
#pragma once

#include <vector>

#include "edit/table_edit.h"
#include "edit/write_back.h"

namespace afterglow::script {

/// A call in the text, and the table within its arguments that holds settings of an entry.
struct Place {
  std::size_t offset = 0;         ///< of the bracket that opens the arguments
  std::size_t argument = 0;       ///< which of them is the table
  std::vector<std::string> path;  ///< keys from that table to the one of settings
};

/// Calls that may have made the entry or volume of an edit, those that fit best first; or the `fx.extend`s that may
/// change it. Errors (script): it is made elsewhere.
Result<std::vector<Place>> places_of(const LuaText& text, const Preset& preset, const std::string& file,
                                     const PresetEdit& edit);

/// The table constructor among the arguments of a call; kNone: an expression or nothing stands there.
std::size_t table_of(const LuaText& text, const Place& place);

struct Change {
  Replacements replacements;  ///< none: nothing to do
  std::size_t at = 0;         ///< offset of the new value in the text once it is replaced; of the call when removed
  std::string before, after;  ///< as in WrittenSetting
};

/// Writes `value` at a place. Errors (script, with file and line): what stands there is an expression.
Result<Change> write_at(const LuaText& text, const std::string& file, const Place& place, const PresetEdit& edit,
                        const SettingValue& value);
/// Removes what is written there; writes `otherwise` where it cannot be removed cleanly. Errors: as write_at.
Result<Change> remove_at(const LuaText& text, const std::string& file, const Place& place, const PresetEdit& edit,
                         const SettingValue& otherwise);

}  // namespace afterglow::script
