// SPDX-License-Identifier: MIT
// Values of settings that are worth trying, from what an effect declares about them.
#pragma once

#include <vector>

#include "script/preset.h"
#include "stress/look.h"
#include "stress/random.h"

namespace afterglow::stress {

/// Both limits and what lies just inside of them (the next 32-bit float, the next integer), every choice, black and
/// 1e30 for colours; where nothing limits it, ±1e12 or, of integers, ±10000. Without the default.
std::vector<SettingValue> hard_values(const SettingSchema& setting);

/// Anywhere that is allowed, at a limit now and then.
SettingValue random_value(const SettingSchema& setting, Random& random);

/// An effect with settings to try: first the defaults, then one setting after the other at each of its hard values,
/// then all at one end. `files`: values for the settings of the type file. The same for the same effect.
std::vector<LookEntry> hard_entries(const EffectSchema& effect, const SearchPath& path);

/// Some settings anywhere, the others at their defaults.
LookEntry random_entry(const EffectSchema& effect, const SearchPath& path, Random& random);

/// An opacity, a blend mode and a mask of `masks` now and then, at least one of them.
void compose(LookEntry& entry, const std::vector<EffectSchema>& masks, Random& random);

/// Up to four of these effects, faded, blended, masked and in groups.
std::vector<LookEntry> random_composition(const std::vector<EffectSchema>& effects,
                                          const std::vector<EffectSchema>& masks, const SearchPath& path,
                                          Random& random);

}  // namespace afterglow::stress
