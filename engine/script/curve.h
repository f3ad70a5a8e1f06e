// SPDX-License-Identifier: MIT
// Values between values: how settings blend, and curves over time. Pure data and mathematics; no Lua.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "script/preset.h"

namespace afterglow::script {

/// a + (b − a)·factor for numbers, vectors and (scene-linear) colours; integers are rounded, halves away from 0;
/// booleans and choices are b from `snap_at` on. Exactly a at 0 and exactly b at 1. `factor` is 0…1; a and b are of one
/// type.
SettingValue interpolate(const SettingValue& a, const SettingValue& b, double factor, double snap_at);

/// How a curve goes from one key to the next: at a constant rate, starting and ending at rest (3u² − 2u³), or by a
/// jump.
enum class Ease { linear, smooth, step };

struct CurveKey {
  double at = 0;
  SettingValue value;
};

/// Held before its first key and after its last.
struct Curve {
  std::vector<CurveKey> keys;  ///< at least one; `at` ascends
  Ease ease = Ease::linear;
  bool in_seconds = false;  ///< `at` is a time; else a frame's number

  SettingValue value(double at) const;
};

}  // namespace afterglow::script
