// SPDX-License-Identifier: MIT
// A stack as data that can be taken apart: entries with the settings that are not at their defaults.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics.h"
#include "script/preset.h"

namespace afterglow::stress {

inline constexpr const char* kGroup = "group";

struct LookEntry {
  std::string effect;
  std::vector<std::pair<std::string, SettingValue>> settings;  ///< those that differ from their defaults
  std::string at;  ///< injection point; empty: the effect's own, and its order
  int order = 0;
  /// How it is put over what it was given, as Lua: "opacity" = "0.5", "mask" = "fx.mask.luma { }".
  std::vector<std::pair<std::string, std::string>> composition = {};
  int depth = 0;  ///< in how many groups it stands: those before it whose effect is "group"
  const SettingValue* find(const std::string& setting) const;
  void set(const std::string& setting, const SettingValue& value);
};

struct Look {
  std::vector<LookEntry> entries;
  std::vector<std::filesystem::path> paths;  ///< where effects and shaders are found besides the installation

  /// Has an entry an opacity, a blend mode or a mask, or is it a group?
  bool is_composed() const;
  /// Without one entry; what stands in a group stays when the group goes.
  Look without(std::size_t entry) const;

  /// The text of a preset that makes this stack.
  std::string text() const;
  /// "fx.glow { threshold = 0 }, …": the stack in one line.
  std::string line() const;
};

/// The entries of a preset that are enabled, in their order, with the settings, opacities, blend modes, masks and
/// groups that they have in the first frame of a picture of this size. Warns of what is tried otherwise than the preset
/// has it (settings that move, mixes). Errors: script.
Result<Look> look_of_preset(const std::filesystem::path& preset, const PresetOptions& options, Size size,
                            Diagnostics& diagnostics);

}  // namespace afterglow::stress
