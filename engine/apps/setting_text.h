// Settings as people read them.
#pragma once

#include <string>

#include "script/explanation.h"
#include "script/preset.h"

namespace afterglow {

std::string allowed_text(const SettingSchema& setting);  ///< "0 to 16", "at least 1", "additive, scattering", "any"

}  // namespace afterglow
