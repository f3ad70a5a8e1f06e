// SPDX-License-Identifier: MIT
// How the settings of a frame came about: what `afterglow explain` prints. Settings as JSON.
#pragma once

#include <array>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "script/preset.h"

namespace afterglow {

/// Where a volume stands in a frame.
struct VolumeState {
  std::string name, file;
  int line = 0;
  double priority = 0, weight = 1;
  std::optional<double> distance = {};  ///< from its shape; empty: global, or no position is known
  double factor = 0;                    ///< 0…1: how much of its settings counts
  std::string reason = {};              ///< why the factor is 0
};

/// What one volume did to one setting.
struct VolumeStep {
  std::string volume;
  double factor = 0;
  SettingValue value = {};   ///< the volume's
  SettingValue result = {};  ///< after blending it in
};

/// A call in a script: `fx.NAME { … }`, `fx.extend("look", { … })`.
struct ScriptPlace {
  std::string file;
  int line = 0;
};

/// A setting on its way from the default to the value that runs.
struct SettingHistory {
  std::string name;
  SettingValue default_value = {};
  std::optional<SettingValue> preset = {};      ///< at this frame
  std::string kind = {};                        ///< of the preset's value: "fixed", "curve", "function"; empty: none
  std::shared_ptr<const ScriptPlace> place = {};  ///< the call that the preset's value stands in; null: not known
  std::vector<VolumeStep> volumes = {};         ///< those that name the setting, in the order of blending
  std::optional<SettingValue> overridden = {};  ///< --set
  SettingValue value = {};                      ///< final
};

struct EntryHistory {
  std::string name;
  std::vector<SettingHistory> settings;  ///< in the schema's order
  /// How it is put over what it was given: "opacity" and "blend", where the effect has no such settings, then those of
  /// the parts of its mask ("mask.luma.from").
  std::vector<SettingHistory> composition = {};
  std::string preset_mask = {};  ///< EntryMask::text of the preset's; empty: it has none

  const SettingHistory* find(const std::string& setting) const;  ///< of both lists; null: none
};

struct Explanation {
  std::optional<Position> position;
  std::string position_from;          ///< "--at", "the preset", "the picture"; empty: no position
  std::vector<VolumeState> volumes;   ///< in the order of blending
  std::vector<EntryHistory> entries;  ///< in the order of execution
};

const char* type_text(SettingType type);  ///< "int", "float", "bool", "enum", "color", "vec2", "vec3", "file"
nlohmann::json value_json(const SettingValue& value);
nlohmann::json setting_json(const SettingSchema& setting);
/// How the value of a setting came about, step by step.
nlohmann::ordered_json history_json(const SettingHistory& setting);
/// How an entry is put over what it was given: "opacity", "blend", "mask" (its text, where it has one) and
/// "composition", how these came about.
void add_composition(nlohmann::ordered_json& entry, const StackEntry& of, const EntryHistory& history);
/// Where the frame is seen from and what its volumes do: "position" (where one is known) and "volumes".
void add_volumes(nlohmann::ordered_json& frame, const Explanation& of);
/// An entry with what became of it: "name", "effect", "state" ("runs", "skipped") and, where it was skipped, "reason".
nlohmann::ordered_json entry_json(const StackEntry& entry, const std::vector<Skipped>& skipped);

}  // namespace afterglow
