// Settings as people and programs read them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "script/preset.h"

namespace afterglow {

const char* type_text(SettingType type);                 ///< "int", "float", "bool", "enum", "color", "vec2"
std::string allowed_text(const SettingSchema& setting);  ///< "0 to 16", "at least 1", "additive, scattering", "any"
nlohmann::json value_json(const SettingValue& value);
nlohmann::json setting_json(const SettingSchema& setting);

}  // namespace afterglow
