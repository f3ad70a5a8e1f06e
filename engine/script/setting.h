// SPDX-License-Identifier: MIT
// Checks values against what an effect declares. The one place that knows what each setting type allows.
#pragma once

#include <optional>
#include <string>

#include "core/result.h"
#include "script/preset.h"
#include "script/value.h"

namespace afterglow::script {

/// What a setting allows, for messages and tables: "0…1", "integer ≥ 1", "additive, scattering", "true, false".
std::string allowed_text(const SettingSchema& schema);

/// Errors (script, without file and line): wrong type, out of range, not finite (or not in a 32-bit float), unknown
/// choice (with the nearest). `full_name` is what the message calls it: "glow.knee".
Result<SettingValue> check_setting(const std::string& full_name, const SettingSchema& schema, const Value& value);

/// Has the file one of the extensions that the setting allows?
bool has_extension(const SettingSchema& schema, const std::string& file);

/// "#rrggbb" for a colour that can be written so: what it is read as is the same colour in 32-bit floats.
std::optional<std::string> hex_color(const SettingValue& color);

/// "integer", "number", "boolean", "choice", "colour", "vec2", "vec3", "file".
const char* type_name(SettingType type);

/// Pushes the value as scripts read it (`s.NAME`); colours and vec2 are read-only tables.
void push_setting(lua_State* lua, const SettingValue& value);

}  // namespace afterglow::script
