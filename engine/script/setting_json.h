// Settings as JSON, for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "script/preset.h"

namespace afterglow {

const char* type_text(SettingType type);  ///< "int", "float", "bool", "enum", "color", "vec2", "vec3", "file"
nlohmann::json value_json(const SettingValue& value);
nlohmann::json setting_json(const SettingSchema& setting);

}  // namespace afterglow
