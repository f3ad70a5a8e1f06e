// SPDX-License-Identifier: MIT
// fx.volume{…}: settings that hold in a part of the scene, or everywhere with a weight.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "script/animated.h"
#include "script/volume_shape.h"

namespace afterglow::script {

struct DeclaredEntry;
struct DeclaredStack;

/// As `fx.volume{…}` made it; which settings it means is decided when the stack is complete.
struct DeclaredVolume {
  std::string name, file;
  int line = 0;
  double priority = 0, blend_distance = 0, snap_at = 0.5;
  Animated weight;
  VolumeShape shape;
  struct Wanted {
    std::string entry, setting;
    Given value;
  };
  std::vector<Wanted> wanted;

  /// A setting of an entry of the stack.
  struct Target {
    std::string entry;
    std::size_t setting = 0;  ///< index in the schema
    Animated value;
  };
  std::vector<Target> targets;
};

/// Fits `volume` to the entries of a stack: fills its targets. Throws ScriptError, located at the volume: unknown entry
/// or setting, values that a setting does not allow.
void aim_volume(lua_State* lua, DeclaredVolume& volume, const std::vector<DeclaredEntry>& entries);

/// What the weight of a volume and a position may be.
const SettingSchema& weight_schema();
const SettingSchema& position_schema();

/// fx.volume.
int declare_volume(lua_State* lua);

}  // namespace afterglow::script
