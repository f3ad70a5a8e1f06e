// SPDX-License-Identifier: MIT
// The settings of a frame: defaults, what the preset says, volumes, overrides, in this order.
#pragma once

#include <optional>
#include <vector>

#include "script/entry_run.h"
#include "script/explanation.h"
#include "script/volume.h"

namespace afterglow::script {

/// What decides the settings besides the entries themselves.
struct Surroundings {
  std::vector<DeclaredVolume> volumes;  ///< by ascending priority
  std::optional<Animated> position;     ///< the preset's
  std::optional<Position> at;           ///< --at: before the preset's, which is before the picture's
};

/// May the settings differ from frame to frame or from place to place?
bool may_change(const EntryRun& run, const Surroundings& surroundings);
bool may_change(const std::vector<EntryRun>& runs, const Surroundings& surroundings);

/// What the preset says about a setting in this frame; volumes and overrides are still to come.
SettingHistory history_of(lua_State* lua, const SettingSchema& schema, const SettingSource& source,
                          const std::string& full_name, const BuildContext& context);

/// Sets StackEntry::named_in where the setting names a file. `volumes`: those of the frame.
void note_named_in(StackEntry& entry, const SettingHistory& setting, const EffectSchema& effect,
                   const std::vector<VolumeState>& volumes = {});

/// Sets `entry.settings` of every run. Throws ScriptError: functions that fail or give what a setting does not allow.
Explanation resolve_settings(lua_State* lua, std::vector<EntryRun>& runs, const Surroundings& surroundings,
                             const BuildContext& context);

}  // namespace afterglow::script
