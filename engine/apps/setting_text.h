// SPDX-License-Identifier: MIT
// Settings as people read them.
#pragma once

#include <string>

#include "script/explanation.h"
#include "script/preset.h"

namespace afterglow {

std::string allowed_text(const SettingSchema& setting);  ///< "0 to 16", "at least 1", "additive, scattering", "any"

/// ", opacity 0.5, blend screen, mask luma * radial", or what of it is not the default.
std::string composition_text(const StackEntry& entry);
/// Opacity and blend mode of most entries are what they are by default; what a mask is made of is told whole.
bool is_said(const SettingHistory& setting);

}  // namespace afterglow
