// SPDX-License-Identifier: MIT
// Does a preset say what edits of another wanted, and everything else as the other did?
#pragma once

#include "edit/write_back.h"
#include "script/explanation.h"

namespace afterglow::script {

/// The preset that `text` in the place of the file's is, without overrides. Errors: as Preset::load.
Result<Preset> load_text(const std::filesystem::path& file, std::string text, PresetOptions options);

/// What the preset itself says of a setting: before volumes, without overrides.
struct Said {
  SettingSchema schema;
  std::optional<SettingValue> value;  ///< of the entry: its default where the preset says nothing; of a volume: empty
  bool moving = false;                ///< a curve or a function
  bool blended = false;               ///< volumes change it
};
/// Errors (usage): unknown names, with the nearest.
Result<Said> said_of(const Preset& preset, const PresetEdit& edit);

/// The same for shaders: 32-bit floats. Integers, choices and booleans exactly.
bool is_same(const SettingValue& a, const SettingValue& b);

/// All but the entries. Errors (script, without file): what differs.
Result<void> check_stack(const Preset& before, const Preset& after);
/// Errors (script, without file): what differs.
Result<void> check_edits(const Preset& before, const Preset& after, const std::vector<PresetEdit>& edits);

}  // namespace afterglow::script
