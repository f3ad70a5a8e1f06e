// SPDX-License-Identifier: MIT
// Checks values against what an effect declares. The one place that knows what each setting type allows.
#pragma once

#include <string>

#include "core/result.h"
#include "script/schema.h"
#include "script/value.h"

namespace afterglow::script {

/// Errors (script, without file and line): wrong type, out of range, not finite (or not in a 32-bit float), unknown
/// choice (with the nearest). `full_name` is what the message calls it: "glow.knee".
Result<SettingValue> check_setting(const std::string& full_name, const SettingSchema& schema, const Value& value);

/// Has the file one of the extensions that the setting allows?
bool has_extension(const SettingSchema& schema, const std::string& file);

/// Pushes the value as scripts read it (`s.NAME`); colours and vec2 are read-only tables.
void push_setting(lua_State* lua, const SettingValue& value);

}  // namespace afterglow::script
