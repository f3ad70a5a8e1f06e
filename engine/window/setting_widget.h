// SPDX-License-Identifier: MIT
// One setting as a row of the panel: what fits its type and range.
#pragma once

#include <optional>

#include "script/preset.h"
#include "window/ui.h"

namespace afterglow {

/// Draws the control at the cursor, `width` wide; the new value when it was changed in this frame. `name` is unique
/// among those drawn in the same ID scope. A double click types a value (typed_value.h); values stay in the setting's
/// range.
std::optional<SettingValue> setting_widget(Ui& ui, const char* name, const SettingSchema& schema,
                                           const SettingValue& value, float width);

/// Does a slider over the setting's range move by factors? Where it spans more than two decades above 0, or begins at 0
/// and the default is a small part of it. So it does to both sides of 0 where it spans many stops: what is set are a few.
/// Vectors as numbers.
bool is_logarithmic(const SettingSchema& schema);

}  // namespace afterglow
